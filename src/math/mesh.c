#include "math/mesh.h"

#include "base/memory.h"

void mesh_clear(mesh *m)
{
    big_free(m->positions);
    big_free(m->normals);
    big_free(m->tangents);
    big_free(m->uvs);
    big_free(m->uvs2);
    big_free(m->colors);
    big_free(m->indices);
    *m = (mesh){0};
}
