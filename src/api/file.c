#include "base/output.h"
#include "nephroid/nephroid.h"

bool neph_file_can_write(const char *path, GError **error)
{
    return output_possible(path, error);
}

bool neph_file_write(const char *path, const char *text, GError **error)
{
    return output_write_text(path, text, error);
}

bool neph_file_spares(const char *path, const char *const *others, GError **error)
{
    return output_spares(path, others, error);
}

void neph_file_abandon_all(void)
{
    output_abandon_all();
}
