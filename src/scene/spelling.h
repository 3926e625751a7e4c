/* British and American spelling of words in scenes. */
#pragma once

enum { TOBI_SPELLING = 64 };

/* The other spelling of a word, as "color" of "colour"; returns 0 if there is none. */
int tobi_spelling_other(const char *word, char other[TOBI_SPELLING]);
