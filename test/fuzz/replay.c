/* Replays files through a fuzz target, where there is no libFuzzer.
   usage: fuzz_<target> FILE-OR-DIRECTORY...    fails if a file takes more than a minute or there is none */
#include "target.h"
#include <dirent.h>
#include <sys/stat.h>

enum { SECONDS = 60 };

static int replay_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    struct stat info;
    if (!file || fstat(fileno(file), &info) != 0 || !S_ISREG(info.st_mode)) {
        fprintf(stderr, "replay: cannot read %s\n", path);
        exit(1);
    }
    /* Exactly as long as the file, so that reading past its end is seen. */
    uint8_t *data = malloc((size_t)info.st_size + !info.st_size);
    if (!data || fread(data, 1, (size_t)info.st_size, file) != (size_t)info.st_size) exit(1);
    fclose(file);
    fprintf(stderr, "%s\n", path);        /* the last line names the culprit */
    alarm(SECONDS);
    LLVMFuzzerTestOneInput(data, (size_t)info.st_size);
    alarm(0);
    free(data);
    return 1;
}

static int replay(const char *path)
{
    DIR *list = opendir(path);
    if (!list) return replay_file(path);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(list));) {
        char file[4096];
        if (entry->d_name[0] == '.') continue;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        count += replay_file(file);
    }
    closedir(list);
    return count;
}

int main(int argc, char **argv)
{
    int count = 0;
    for (int i = 1; i < argc; i++) count += replay(argv[i]);
    printf("%d inputs\n", count);
    return count == 0;
}
