/* The language of the program and of the library's messages. It is chosen before the first text. */
#pragma once

/* The Japanese of an English text, where that was chosen and there is one; else the text itself. */
const char *tr(const char *text) __attribute__((format_arg(1)));
/* Marks a text that tr gets later. */
#define TEXT(text) text

/* "ja" or "en"; NULL: as LC_ALL, LC_MESSAGES or LANG say. -1: another name, and nothing changes. */
int choose_language(const char *name);
/* "ja" or "en" */
const char *language_name(void);
