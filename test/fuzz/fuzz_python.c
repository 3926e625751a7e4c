/* A Python parameter file: what it becomes must be JSON, and what is refused must be told. */
#include "target.h"
#include "scene/python.h"
#include <jansson.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tobi_report *report = tobi_report_create();
    tobi_error err = { 0 };
    char *json = NULL;
    PROMISE(report);
    tobi_status status = tobi_python_to_json("p.py", (const char *)data, size, &json, report, &err);
    PROMISE((status == TOBI_OK) == (json != NULL));
    if (status == TOBI_INVALID) PROMISE(tobi_report_total(report) > 0);
    json_t *root = json ? json_loads(json, 0, NULL) : NULL;
    PROMISE(!json || json_is_object(root));
    json_decref(root);
    free(json);
    tobi_report_free(report);
    return 0;
}
