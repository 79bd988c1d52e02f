// nanoflann's kd-tree over photons, behind functions that C can call: sums of flux without a list, by its own result sets.

#include <nanoflann.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

struct Position { float x[3]; };
// What a photon carries beside its place.
struct Load { float flux[3], normal[3]; };
struct Query { float position[3], radius, normal[3]; };
struct Answer { float flux[3]; uint32_t count; float farthest_sq; };

namespace {

struct Cloud {
    std::vector<Position> positions;
    std::vector<Load> loads;
    size_t kdtree_get_point_count() const { return positions.size(); }
    float kdtree_get_pt(size_t i, size_t axis) const { return positions[i].x[axis]; }
    template <class B> bool kdtree_get_bbox(B &) const { return false; }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3>;

struct Search {
    Cloud cloud;
    Tree tree;
    Search(const Position *positions, const Load *loads, size_t count, size_t leaf)
        : cloud{{positions, positions + count}, {loads, loads + count}},
          tree(3, cloud, {leaf, nanoflann::KDTreeSingleIndexAdaptorFlags::SkipInitialBuildIndex}) {}
};

// Within 60 degrees.
bool faces(const Load &load, const Query &query) {
    const float *a = load.normal, *b = query.normal;
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] >= 0.5f;
}

// The search leaves out what lies at the limit itself.
float limit_of(const Query &query) {
    return std::nextafter(query.radius * query.radius, std::numeric_limits<float>::infinity());
}

// Sums what lies within the radius.
struct Sums {
    using DistanceType = float;
    const Load *loads;
    const Query &query;
    float limit;
    Answer answer;
    size_t size() const { return answer.count; }
    bool full() const { return true; }
    float worstDist() const { return limit; }
    bool addPoint(float distance_sq, uint32_t i) {
        const Load &load = loads[i];
        if (faces(load, query)) {
            for (int c = 0; c < 3; ++c) answer.flux[c] += load.flux[c];
            answer.count += 1;
            if (distance_sq > answer.farthest_sq) answer.farthest_sq = distance_sq;
        }
        return true;
    }
};

// The nearest in order, as the library's own set of them keeps them, of those that face the query.
struct Nearest {
    using DistanceType = float;
    const Load *loads;
    const Query &query;
    float limit;
    size_t k;
    float *distances;
    uint32_t *ids;
    size_t count;
    size_t size() const { return count; }
    bool full() const { return count == k; }
    float worstDist() const { return count == k ? distances[k - 1] : limit; }
    bool addPoint(float distance_sq, uint32_t id) {
        if (!faces(loads[id], query)) return true;
        // The leaf looked at the limit before its first photon.
        if (count == k && !(distance_sq < distances[k - 1])) return true;
        size_t i = count < k ? count++ : k - 1;
        for (; i > 0 && distances[i - 1] > distance_sq; --i) {
            distances[i] = distances[i - 1];
            ids[i] = ids[i - 1];
        }
        distances[i] = distance_sq;
        ids[i] = id;
        return true;
    }
};

}  // namespace

extern "C" {

uint32_t peer_version() { return NANOFLANN_VERSION; }

// Null where memory is short.
void *peer_new(const Position *positions, const Load *loads, size_t count, size_t leaf) {
    try {
        return new Search(positions, loads, count, leaf);
    } catch (...) {
        return nullptr;
    }
}

bool peer_build(void *handle) {
    try {
        static_cast<Search *>(handle)->tree.buildIndex();
        return true;
    } catch (...) {
        return false;
    }
}

// Puts the photons into the order of the leaves and builds again, so that searches read memory in order.
bool peer_settle(void *handle) {
    try {
        Search &search = *static_cast<Search *>(handle);
        Cloud sorted;
        sorted.positions.reserve(search.tree.vAcc.size());
        sorted.loads.reserve(search.tree.vAcc.size());
        for (auto i : search.tree.vAcc) {
            sorted.positions.push_back(search.cloud.positions[i]);
            sorted.loads.push_back(search.cloud.loads[i]);
        }
        std::swap(search.cloud, sorted);
        search.tree.buildIndex();
        return true;
    } catch (...) {
        return false;
    }
}

void peer_free(void *handle) { delete static_cast<Search *>(handle); }

void peer_flux(const void *handle, const Query *queries, size_t count, Answer *answers) {
    const Search &search = *static_cast<const Search *>(handle);
    for (size_t i = 0; i < count; ++i) {
        Sums sums{search.cloud.loads.data(), queries[i], limit_of(queries[i]), {{0, 0, 0}, 0, 0}};
        search.tree.findNeighbors(sums, queries[i].position, {});
        answers[i] = sums.answer;
    }
}

// At least one nearest and at most 256.
void peer_nearest(const void *handle, const Query *queries, size_t count, size_t k, Answer *answers) {
    const Search &search = *static_cast<const Search *>(handle);
    const Load *loads = search.cloud.loads.data();
    float distances[256];
    uint32_t ids[256];
    for (size_t i = 0; i < count; ++i) {
        Nearest nearest{loads, queries[i], limit_of(queries[i]), k, distances, ids, 0};
        search.tree.findNeighbors(nearest, queries[i].position, {});
        Answer answer{{0, 0, 0}, static_cast<uint32_t>(nearest.count), 0};
        for (size_t j = 0; j < nearest.count; ++j)
            for (int c = 0; c < 3; ++c) answer.flux[c] += loads[ids[j]].flux[c];
        if (nearest.count > 0) answer.farthest_sq = distances[nearest.count - 1];
        answers[i] = answer;
    }
}

}
