#include "base/words.h"

#include <glib.h>
#include <string.h>

enum { LONGEST_WORD = 63 };

size_t edit_distance(const char *a, const char *b)
{
    size_t row[LONGEST_WORD + 1]; /* of the table: distances from a[0..i) to b[0..j) */
    const size_t n = MIN(strlen(b), LONGEST_WORD);
    for (size_t j = 0; j <= n; j++)
        row[j] = j;
    for (size_t i = 0; a[i]; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < n; j++) {
            size_t change = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = MIN(change, 1 + MIN(row[j], row[j + 1]));
        }
    }
    return row[n];
}
