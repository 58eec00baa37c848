/*
 * What of pbrt-v4 is read, as a table: made from the tables of kinds themselves.
 */
#pragma once

/** @brief A Markdown table of pbrt-v4's directives and kinds: rendered, approximated or
 * refused, with the parameters that are read. Owned by the caller. */
char *features_markdown(void);
