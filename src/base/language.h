/* Texts for users, in their language. */
#pragma once

/* The text in the language of tobi_set_language,
where the catalogue src/ja.po has it; else itself. Formats of
   errors and mistakes are looked up where they are filled in; what goes into them as %s, and notes, by tr. */
const char *tobi_text(const char *english) __attribute__((format_arg(1)));
#define tr(text) tobi_text(text)
/* Marks a text that tr gets later. */
#define TR(text) text
/* The same of meanings of keys: the catalogue of the page of scenes, docs/scene.ja.po, without its links. The
   answer may stand in room. */
enum { TOBI_MEANING = 3000 };
const char *tobi_meaning(const char *english, char room[TOBI_MEANING]);
/* strerror in that language; as there, the text may change with the next call. */
const char *tobi_reason(int code);
/* Drops the piece of a letter in UTF-8 at the end of a text that was cut. */
void tobi_text_mend(char *text);
