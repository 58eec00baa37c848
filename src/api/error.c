#include "base/error.h"
#include "base/printable.h"
#include "nephroid/nephroid.h"

_Static_assert(NEPH_ERROR_INPUT == (int)ERROR_INPUT, "codes are one list");
_Static_assert(NEPH_ERROR_USAGE == (int)ERROR_USAGE, "codes are one list");
_Static_assert(NEPH_ERROR_FAILED == (int)ERROR_FAILED, "codes are one list");
_Static_assert(NEPH_ERROR_CANCELLED == (int)ERROR_CANCELLED, "codes are one list");

GQuark neph_error_quark(void)
{
    return error_quark();
}

char *neph_text_printable(const char *text)
{
    return printable(text);
}
