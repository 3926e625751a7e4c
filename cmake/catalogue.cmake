# tobi_catalogue(NAME FILE.po OUT): writes a source file with the texts of a gettext catalogue, NAME_sort() and
# NAME_find(text); OUT gets its path. Strings of a PO file are strings of C, so its pairs become rows of a table.
function(tobi_catalogue NAME file out)
    set_property(DIRECTORY "${PROJECT_SOURCE_DIR}" APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${file}")
    file(READ "${PROJECT_SOURCE_DIR}/${file}" ROWS)
    string(REGEX REPLACE "(^|\n)#[^\n]*" "\\1" ROWS "${ROWS}")
    string(REGEX REPLACE "(^|\n)msgid " "\\1}, { " ROWS "${ROWS}")
    string(REGEX REPLACE "\nmsgstr " "\n, " ROWS "${ROWS}")
    set(CATALOGUE "${file}")
    set(path "${PROJECT_BINARY_DIR}/language/${NAME}.c")
    configure_file("${PROJECT_SOURCE_DIR}/cmake/catalogue.c.in" "${path}" @ONLY)
    set(${out} "${path}" PARENT_SCOPE)
endfunction()
