#include "nanoflann.h"

#include <nanoflann.hpp>
#include <vector>

namespace
{
struct Points {
    const float *xyz;
    size_t n;
    size_t kdtree_get_point_count() const
    {
        return n;
    }
    float kdtree_get_pt(size_t i, size_t axis) const
    {
        return xyz[3 * i + axis];
    }
    template <class Box> bool kdtree_get_bbox(Box &) const
    {
        return false;
    }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                        Points, 3, uint32_t>;
} // namespace

struct peer_tree {
    Points points;
    Tree tree;
    mutable std::vector<std::pair<uint32_t, float>> matches;
    mutable std::vector<uint32_t> index;
    mutable std::vector<float> distance2;

    peer_tree(const float *xyz, size_t n)
        : points{xyz, n}, tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(16))
    {
        tree.buildIndex();
    }
};

peer_tree *peer_build(const float *xyz, size_t n)
{
    return new peer_tree(xyz, n);
}

void peer_free(peer_tree *tree)
{
    delete tree;
}

size_t peer_within(const peer_tree *tree, const float p[3], float radius)
{
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    return tree->tree.radiusSearch(p, radius * radius, tree->matches, unsorted);
}

size_t peer_nearest(const peer_tree *tree, const float p[3], size_t k)
{
    tree->index.resize(k);
    tree->distance2.resize(k);
    return tree->tree.knnSearch(p, k, tree->index.data(), tree->distance2.data());
}
