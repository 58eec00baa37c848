/*
 * text: numbers are rounded as the C library rounds them, and words carry their places.
 */
#include "format/lexer.h"
#include "format/number.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void check_number(const char *text)
{
    float single = -1.0f;
    double twice = -1.0;
    float want_single = strtof(text, NULL);
    double want_twice = strtod(text, NULL);
    g_assert_true(number_float(text, strlen(text), &single) == isfinite(want_single));
    g_assert_true(number_double(text, strlen(text), &twice) == isfinite(want_twice));
    if (isfinite(want_single) && memcmp(&single, &want_single, sizeof single) != 0)
        g_error("%s: expected %.9g, found %.9g", text, (double)want_single,
                (double)single);
    if (isfinite(want_twice) && memcmp(&twice, &want_twice, sizeof twice) != 0)
        g_error("%s: expected %.17g, found %.17g", text, want_twice, twice);
}

static void test_numbers_by_hand(void)
{
    static const char *const texts[] = {
        "0",
        "-0",
        "1",
        "+1",
        "-1.5",
        ".5",
        "5.",
        "1e3",
        "1E-3",
        "1.25e+2",
        "4.37114e-8",
        "1.91069e-15",
        "123456789012345678901234567890",
        "1e400",
        "-1e400",
        "3.4028235e38",
        "3.4028236e38",
        "1e-45",
        "7e-46",
        "1.17549435e-38",
        "16777217",
        "16777217.0000000000000000001",
        "9007199254740993",
        "1e22",
        "1e23",
        "0.000000000000000000000000000000000000000000000000000000000001",
        "0000000000000000000000000000000000000012.5",
        "179769313486231580793e289"};
    for (size_t i = 0; i < G_N_ELEMENTS(texts); i++)
        check_number(texts[i]);
}

/* The C library, in its own locale, is the oracle; it reads every digit. */
static void test_numbers_at_random(void)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(7);
    for (int i = 0; i < 200000; i++) {
        char text[64];
        int digits = g_rand_int_range(random, 1, 20);
        int n = g_rand_boolean(random) ? g_snprintf(text, sizeof text, "-") : 0;
        int dot = g_rand_int_range(random, 0, digits + 1);
        for (int d = 0; d < digits; d++)
            n += g_snprintf(text + n, sizeof text - (gulong)n, "%s%d",
                            d == dot ? "." : "", g_rand_int_range(random, 0, 10));
        if (g_rand_boolean(random))
            g_snprintf(text + n, sizeof text - (gulong)n, "e%d",
                       g_rand_int_range(random, -50, 50));
        check_number(text);
    }
}

/* Just beside the middle of two floats, where rounding twice goes wrong. */
static void test_numbers_near_the_middle(void)
{
    g_autoptr(GRand) random = g_rand_new_with_seed(8);
    for (int i = 0; i < 100000; i++) {
        uint32_t bits = (uint32_t)g_rand_int_range(random, 0x30000000, 0x4f000000);
        float low;
        memcpy(&low, &bits, sizeof low);
        double middle = ((double)low + (double)nextafterf(low, INFINITY)) / 2.0;
        char text[80];
        g_snprintf(text, sizeof text, "%.*e", g_rand_int_range(random, 8, 40), middle);
        check_number(text);
    }
}

static void test_what_is_no_number(void)
{
    static const char *const texts[] = {"",    "-",   ".",    "e5",    "1e",    "1e+",
                                        "nan", "inf", "0x10", "1,5",   "1.2.3", "--1",
                                        "1 ",  "1f",  "INF",  "1e5.0", "١"};
    for (size_t i = 0; i < G_N_ELEMENTS(texts); i++) {
        float single;
        double twice;
        int whole;
        g_assert_false(number_float(texts[i], strlen(texts[i]), &single));
        g_assert_false(number_double(texts[i], strlen(texts[i]), &twice));
        g_assert_false(number_int(texts[i], strlen(texts[i]), &whole));
    }
}

static void test_whole_numbers(void)
{
    int value = 0;
    g_assert_true(number_int("2147483647", 10, &value));
    g_assert_cmpint(value, ==, G_MAXINT);
    g_assert_true(number_int("-2147483648", 11, &value));
    g_assert_cmpint(value, ==, G_MININT);
    g_assert_true(number_int("+12", 3, &value));
    g_assert_cmpint(value, ==, 12);
    g_assert_false(number_int("2147483648", 10, &value));
    g_assert_false(number_int("99999999999999999999", 20, &value));
    g_assert_false(number_int("1.0", 3, &value));
}

static void next_is(lexer *l, token_kind kind, const char *text, int line, int column)
{
    token t = lexer_next(l);
    g_assert_cmpint(t.kind, ==, kind);
    g_autofree char *found = g_strndup(t.text, t.length);
    g_assert_cmpstr(found, ==, text);
    g_assert_cmpint(t.place.line, ==, line);
    g_assert_cmpint(t.place.column, ==, column);
}

static void test_words_and_places(void)
{
    const char *text = "\xef\xbb\xbf# first\r\nShape \"sphere\"#no\n  [1 -2e5]\"a b\"\n"
                       "\t\"open\nEnd";
    lexer l = lexer_new("a.pbrt", text, strlen(text));
    g_assert_cmpint(lexer_peek(&l).kind, ==, TOKEN_WORD);
    next_is(&l, TOKEN_WORD, "Shape", 2, 1);
    next_is(&l, TOKEN_STRING, "sphere", 2, 7);
    next_is(&l, TOKEN_LEFT, "[", 3, 3);
    next_is(&l, TOKEN_WORD, "1", 3, 4);
    next_is(&l, TOKEN_WORD, "-2e5", 3, 6);
    next_is(&l, TOKEN_RIGHT, "]", 3, 10);
    next_is(&l, TOKEN_STRING, "a b", 3, 11);
    next_is(&l, TOKEN_UNTERMINATED, "open", 4, 2);
    next_is(&l, TOKEN_WORD, "End", 5, 1);
    next_is(&l, TOKEN_END, "", 5, 4);
    next_is(&l, TOKEN_END, "", 5, 4);
}

static void test_escapes(void)
{
    const char *text = "\"a\\\"b\\\\c\\n\\td\" \"e\\";
    lexer l = lexer_new("a.pbrt", text, strlen(text));
    token t = lexer_next(&l);
    g_autofree char *first = token_string(&t);
    g_assert_cmpint(t.kind, ==, TOKEN_STRING);
    g_assert_cmpstr(first, ==, "a\"b\\c\n\td");
    t = lexer_next(&l);
    g_autofree char *second = token_string(&t);
    g_assert_cmpint(t.kind, ==, TOKEN_UNTERMINATED);
    g_assert_cmpstr(second, ==, "e\\");
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/text/numbers-by-hand", test_numbers_by_hand);
    g_test_add_func("/text/numbers-at-random", test_numbers_at_random);
    g_test_add_func("/text/numbers-near-the-middle", test_numbers_near_the_middle);
    g_test_add_func("/text/what-is-no-number", test_what_is_no_number);
    g_test_add_func("/text/whole-numbers", test_whole_numbers);
    g_test_add_func("/text/words-and-places", test_words_and_places);
    g_test_add_func("/text/escapes", test_escapes);
    return g_test_run();
}
