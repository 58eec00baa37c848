#include "format/features/features.h"
#include "nephroid/nephroid.h"

char *neph_features_describe(void)
{
    return features_markdown();
}
