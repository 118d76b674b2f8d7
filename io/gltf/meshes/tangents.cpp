// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/meshes/tangents.h"

#include <bit>
#include <numeric>
#include <unordered_map>

namespace petzval::io {
namespace {

using Triangle = std::array<uint32_t, 3>;

V3d face_normal(const Mesh& mesh, const Triangle& t) {  // as long as twice the area
    const V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    return (b - a).cross(c - a);
}

bool usable(const V3d& v) {
    const double square = v.dot(v);
    return square > 0 && std::isfinite(square);
}

V3d across(const V3d& v, const V3d& unit_normal) {
    return v - unit_normal * v.dot(unit_normal);
}

/// Texture coordinates as a map reads them; empty where there are none.
std::vector<V2f> uv_of_map(const Mesh& mesh, const TextureSlot& map) {
    std::vector<V2f> out;
    for (const V2f& uv : mesh.uv_of(map.uv_set))
        out.push_back({map.u_row[0] * uv.x + map.u_row[1] * uv.y + map.u_row[2],
                       map.v_row[0] * uv.x + map.v_row[1] * uv.y + map.v_row[2]});
    return out;
}

/// Twice the signed area of a face in the texture; 0 where it is of no use.
double texture_area(const std::vector<V2f>& uv, const Triangle& t) {
    const V2f a = uv[t[1]] - uv[t[0]], b = uv[t[2]] - uv[t[0]];
    const double area = double(a.x) * b.y - double(b.x) * a.y;
    return std::isfinite(area) ? area : 0;
}

enum class Side : uint8_t { Unknown, Plain, Mirrored };

Side side_of(double texture_area) {
    return texture_area > 0 ? Side::Mirrored : texture_area < 0 ? Side::Plain : Side::Unknown;
}

/// Each corner becomes a vertex of its own.
void unshare_vertices(SourceMesh& source) {
    std::vector<uint32_t> from;
    from.reserve(source.mesh.triangles.size() * 3);
    for (Triangle& t : source.mesh.triangles)
        for (uint32_t& vertex : t) {
            from.push_back(vertex);
            vertex = static_cast<uint32_t>(from.size() - 1);
        }
    source.gather(from);
}

/// The first face to use a vertex decides its side; faces of the other side share a copy of it.
void split_sides(SourceMesh& source, const std::vector<V2f>& uv) {
    const size_t count = source.mesh.positions.size();
    std::vector<Side> sides(count, Side::Unknown);
    std::vector<uint32_t> from(count), copy(count, 0);
    std::iota(from.begin(), from.end(), 0u);
    for (Triangle& t : source.mesh.triangles) {
        const Side wanted = side_of(texture_area(uv, t));
        if (wanted == Side::Unknown) continue;
        for (uint32_t& vertex : t) {
            if (sides[vertex] == Side::Unknown) sides[vertex] = wanted;
            if (sides[vertex] == wanted) continue;
            if (copy[vertex] == 0) {
                copy[vertex] = static_cast<uint32_t>(from.size());
                from.push_back(vertex);
            }
            vertex = copy[vertex];
        }
    }
    if (from.size() > count) source.gather(from);
}

struct HashFloats {
    size_t operator()(const std::array<float, 8>& key) const {
        uint32_t hash = 0;
        for (float f : key) hash = hash32(std::bit_cast<uint32_t>(f), hash);
        return hash;
    }
};

class TangentBuilder {
  public:
    TangentBuilder(Mesh& mesh, std::vector<V2f> uv)
        : mesh_(mesh), flat_(mesh.normals.empty()), uv_(std::move(uv)) {}

    void build() {
        find_equal_vertices();
        sums_.assign(2 * mesh_.positions.size(), V3d(0.0));
        sides_.assign(mesh_.positions.size(), Side::Unknown);
        for (const Triangle& t : mesh_.triangles) add_face(t);
        set_tangents();
    }

  private:
    [[nodiscard]] V3d normal(const Triangle& t, int corner) const {
        return flat_ ? face_normal(mesh_, t).normalized()
                     : V3d(mesh_.normals[t[static_cast<size_t>(corner)]]);
    }

    // Files without indices repeat vertices; the tangents of equal ones must still be those of one
    // surface.
    void find_equal_vertices() {
        equal_.resize(mesh_.positions.size());
        std::iota(equal_.begin(), equal_.end(), 0u);
        if (flat_) return;
        std::unordered_map<std::array<float, 8>, uint32_t, HashFloats> first;
        first.reserve(equal_.size());
        for (uint32_t i = 0; i < equal_.size(); ++i) {
            const V3f &p = mesh_.positions[i], &n = mesh_.normals[i];
            equal_[i] = first.try_emplace({p.x, p.y, p.z, n.x, n.y, n.z, uv_[i].x, uv_[i].y}, i)
                            .first->second;
        }
    }

    [[nodiscard]] V3d& sum(uint32_t vertex, bool mirrored) {
        return sums_[2 * equal_[vertex] + (mirrored ? 1 : 0)];
    }

    void add_face(const Triangle& t) {
        const double area = texture_area(uv_, t);
        if (area == 0) return;
        for (const uint32_t vertex : t)
            if (sides_[vertex] == Side::Unknown) sides_[vertex] = side_of(area);
        const V2f ta = uv_[t[1]] - uv_[t[0]], tb = uv_[t[2]] - uv_[t[0]];
        const V3d p[3] = {V3d(mesh_.positions[t[0]]), V3d(mesh_.positions[t[1]]),
                          V3d(mesh_.positions[t[2]])};
        const V3d along_u = ((p[1] - p[0]) * tb.y - (p[2] - p[0]) * ta.y) * (area < 0 ? -1.0 : 1.0);
        for (int k = 0; k < 3; ++k) {
            const V3d n = normal(t, k);
            const V3d tangent = across(along_u, n);
            const V3d to_next = across(p[(k + 1) % 3] - p[k], n);
            const V3d to_last = across(p[(k + 2) % 3] - p[k], n);
            if (!usable(tangent) || !usable(to_next) || !usable(to_last)) continue;
            const double angle = std::atan2(to_next.cross(to_last).length(), to_next.dot(to_last));
            sum(t[static_cast<size_t>(k)], area > 0) += tangent.normalized() * angle;
        }
    }

    void set_tangents() {
        mesh_.tangents.assign(mesh_.positions.size(), V4f(0.f, 0.f, 0.f, 1.f));
        for (const Triangle& t : mesh_.triangles)
            for (int k = 0; k < 3; ++k) {
                const uint32_t vertex = t[static_cast<size_t>(k)];
                const bool mirrored = sides_[vertex] == Side::Mirrored;
                const V3d n = normal(t, k);
                V3d tangent = across(sum(vertex, mirrored), n);
                if (!usable(tangent)) tangent = V3d(Frame::about(V3f(n)).x);
                tangent.normalize();
                mesh_.tangents[vertex] =
                    V4f(static_cast<float>(tangent.x), static_cast<float>(tangent.y),
                        static_cast<float>(tangent.z), mirrored ? -1.f : 1.f);
            }
    }

    Mesh& mesh_;
    bool flat_;
    std::vector<V2f> uv_;
    std::vector<uint32_t> equal_;  ///< the first vertex that is the same in all that counts
    std::vector<V3d> sums_;        ///< of tangents, one for each vertex and side
    std::vector<Side> sides_;
};

}  // namespace

size_t repair_normals(Mesh& mesh) {
    std::vector<bool> bad(mesh.normals.size(), false);
    size_t count = 0;
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        const V3d n(mesh.normals[i]);
        bad[i] = !usable(n);
        count += bad[i];
        mesh.normals[i] = bad[i] ? V3f(0.f) : V3f(n / std::sqrt(n.dot(n)));
    }
    if (count == 0) return 0;

    std::vector<V3d> sums(mesh.normals.size(), V3d(0.0));
    for (const Triangle& t : mesh.triangles)
        for (uint32_t vertex : t)
            if (bad[vertex]) sums[vertex] += face_normal(mesh, t);
    for (size_t i = 0; i < mesh.normals.size(); ++i)
        if (bad[i]) mesh.normals[i] = usable(sums[i]) ? V3f(sums[i].normalized()) : V3f(0, 0, 1);
    return count;
}

void repair_tangents(Mesh& mesh) {
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
        V4f& t = mesh.tangents[i];
        V3d direction(t.x, t.y, t.z);
        if (!usable(across(direction, V3d(mesh.normals[i]))))
            direction = V3d(Frame::about(mesh.normals[i]).x);
        const V3f unit_direction(direction.normalized());
        t = {unit_direction.x, unit_direction.y, unit_direction.z, t.w < 0.f ? -1.f : 1.f};
    }
}

void split_for_tangents(SourceMesh& source, const TextureSlot& normal_map) {
    const std::vector<V2f> uv = uv_of_map(source.mesh, normal_map);
    if (uv.empty()) return;
    if (source.mesh.normals.empty())
        unshare_vertices(source);
    else
        split_sides(source, uv);
}

void add_tangents(Mesh& mesh, const TextureSlot& normal_map) {
    std::vector<V2f> uv = uv_of_map(mesh, normal_map);
    if (!uv.empty()) TangentBuilder(mesh, std::move(uv)).build();
}

}  // namespace petzval::io
