// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/framing.h"

#include <Imath/ImathMatrixAlgo.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::apps {
namespace {

// Embree takes coordinates up to about 1e18; the square of a distance must be a float as well.
constexpr double kFarthest_m = 1e16;
constexpr double kNearest_m = 1e-6;
constexpr double kMargin = 0.06;         ///< of half the picture, on each side
constexpr double kWidestHalf_rad = 0.8;  ///< a wider view gets wider margins: its rim is stretched
constexpr double kFlat = 0.2;            ///< thickness over the next larger side

constexpr size_t kMostTriangles = 1 << 22;  ///< that a mean direction is found from

size_t triangle_count(const Scene& scene, uint32_t instance) {
    return scene.meshes[scene.instances[instance].mesh].triangles.size();
}

// Visits triangles of the whole scene at even steps, all of them where they are not too many.
template <class Visit>
void sample_triangles(const Scene& scene, Visit visit) {
    size_t all = 0;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) all += triangle_count(scene, i);
    const size_t step = 1 + all / kMostTriangles;
    size_t next = 0;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const size_t count = triangle_count(scene, i);
        for (; next < count; next += step)
            visit(triangle_corners(scene, i, static_cast<uint32_t>(next)));
        next -= count;
    }
}

// Visits all corners of triangles, but those of instances that lie in a box of which no point
// matters: there may be millions.
template <class Matters, class Visit>
void each_corner(const Scene& scene, Matters matters, Visit visit) {
    const std::vector<Box3f> boxes = mesh_boxes(scene);
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (!instance.identity) {
            const Box3f box = placed_box(boxes[instance.mesh], instance.to_world);
            bool any = false;
            for (int k = 0; k < 8; ++k)
                any |= matters(V3d(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                                   k & 4 ? box.max.z : box.min.z));
            if (!any) continue;
        }
        for (uint32_t triangle = 0; triangle < triangle_count(scene, i); ++triangle)
            for (const V3f& p : triangle_corners(scene, i, triangle)) visit(V3d(p));
    }
}

// Normal of a scene that is flat, but along no axis: the direction that the normals of most of its
// area have or are opposite to, by the greatest eigenvector of their covariance.
std::optional<V3d> slanting_normal(const Scene& scene) {
    Imath::M33d covariance(0.0), axes;
    sample_triangles(scene, [&](const std::array<V3f, 3>& corner) {
        const V3d a(corner[0]), twice_area = (V3d(corner[1]) - a).cross(V3d(corner[2]) - a);
        const double length = twice_area.length();
        if (!(length > 0)) return;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) covariance[i][j] += twice_area[i] * twice_area[j] / length;
    });
    V3d area;
    Imath::jacobiEigenSolver(covariance, area, axes);  // axes: in the columns
    Imath::Box3d along;
    each_corner(
        scene, [&](const V3d& p) { return !along.intersects(p * axes); },
        [&](const V3d& p) { along.extendBy(p * axes); });
    const V3d size = along.size();
    const int n = area.x > std::max(area.y, area.z) ? 0 : area.y > area.z ? 1 : 2;
    if (!(size[n] < kFlat * std::min(size[(n + 1) % 3], size[(n + 2) % 3]))) return std::nullopt;
    return V3d(axes[0][n], axes[1][n], axes[2][n]);
}

// Direction from a scene of that size to the eye, not of unit length: three sides of a cube show.
V3d view_direction(const Scene& scene, const V3d& size) {
    const V3d usual(0.55, 0.45, 1);
    if (size.x < kFlat * std::min(size.y, size.z)) return {1, 0.45, 0.55};
    if (size.y < kFlat * std::min(size.x, size.z)) return {0.55, 0.9, 1};
    if (size.z < kFlat * std::min(size.x, size.y)) return usual;
    const auto normal = slanting_normal(scene);
    if (!normal) return usual;
    return *normal * (normal->dot(usual) < 0 ? -1 : 1) + usual.normalized() / 2;
}

/// Axes of an upright view: right, up, and back towards the eye.
struct ViewAxes {
    V3d right, up, back;

    explicit ViewAxes(const V3d& to_eye)
        : right(V3d(0, 1, 0).cross(to_eye).normalized()),
          up(to_eye.cross(right).normalized()),
          back(to_eye.normalized()) {}
    [[nodiscard]] V3d to_view(const V3d& p) const { return {p.dot(right), p.dot(up), p.dot(back)}; }
    [[nodiscard]] V3d to_world(const V3d& v) const { return right * v.x + up * v.y + back * v.z; }
};

/// The four planes through the sides of a picture, moved in from far away until they touch the
/// scene. One of them holds the points where coordinate + slope * z is a constant: the largest that
/// a point of the scene has.
class Frustum {
  public:
    explicit Frustum(const std::array<double, 2>& slope) : slope_(slope) {}
    void add(const V3d& p) {
        for (int i = 0; i < 2; ++i) {
            const double depth = slope_[i] * p.z;
            most_[i] = {std::max(most_[i][0], depth - p[i]), std::max(most_[i][1], depth + p[i])};
        }
        nearest_ = std::max(nearest_, p.z);
    }
    /// Whether a point would move no plane.
    [[nodiscard]] bool holds(const V3d& p) const {
        Frustum moved = *this;
        moved.add(p);
        return moved.most_ == most_ && moved.nearest_ == nearest_;
    }
    /// The nearest point from which all is seen. Opposite planes meet in a line; the eye stands on
    /// the one further back, midway between the other two planes.
    [[nodiscard]] V3d eye() const {
        V3d eye(0, 0, nearest_ + kNearest_m);
        for (int i = 0; i < 2; ++i) {
            eye[i] = (most_[i][1] - most_[i][0]) / 2;
            eye.z = std::max(eye.z, (most_[i][0] + most_[i][1]) / (2 * slope_[i]));
        }
        return eye;
    }

  private:
    static constexpr double kNone = -std::numeric_limits<double>::infinity();
    std::array<double, 2> slope_;  ///< tangents of half the angles of view, across and upright
    std::array<std::array<double, 2>, 2> most_{{{kNone, kNone}, {kNone, kNone}}};
    double nearest_ = kNone;
};

}  // namespace

std::optional<std::array<V3f, 2>> frame_scene(const Scene& scene, float yfov_rad, float aspect,
                                              double stand_back_m, bool all_around) {
    if (scene.bounds.isEmpty()) return std::array{V3f(0, 0, 1), V3f(0, 0, 0)};
    const V3d low(scene.bounds.min), high(scene.bounds.max), centre = low / 2 + high / 2;
    const ViewAxes axes(view_direction(scene, high - low));
    const double slope = std::tan(std::min(double(yfov_rad) / 2, kWidestHalf_rad)) * (1 - kMargin);
    Frustum frustum({slope * double(aspect), slope});
    const auto each_turned = [&](const V3d& p, const auto& visit) {
        const V3d from(p - centre);
        if (!all_around) return visit(axes.to_view(from));
        // The circle on which a point turns, by a polygon around it.
        constexpr int kSides = 32;
        const double radius = std::hypot(from.x, from.z) / std::cos(M_PI / kSides);
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2 * M_PI * i / kSides;
            visit(axes.to_view({radius * std::cos(angle), from.y, radius * std::sin(angle)}));
        }
    };
    const auto matters = [&](const V3d& p) {
        bool any = false;
        each_turned(p, [&](const V3d& v) { any = any || !frustum.holds(v); });
        return any;
    };
    each_corner(scene, matters, [&](const V3d& p) {
        if (!all_around || matters(p)) each_turned(p, [&](const V3d& v) { frustum.add(v); });
    });
    V3d eye = frustum.eye();
    eye.z += stand_back_m;
    const std::array placed{V3f(centre + axes.to_world(eye)),
                            V3f(centre + axes.to_world({eye.x, eye.y, 0}))};
    if (!(std::max(eye.length(), centre.length()) < kFarthest_m) || placed[0] == placed[1])
        return std::nullopt;
    return placed;
}

}  // namespace petzval::apps
