// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/traced_ray.h"

#include "camera/lens/trace.h"

namespace petzval {
namespace {

Vec3<d4> in_all_lanes(const V3d& v) {
    return {broadcast<d4>(v.x), broadcast<d4>(v.y), broadcast<d4>(v.z)};
}

V3d first_lane(const Vec3<d4>& v) {
    return {v.x[0], v.y[0], v.z[0]};
}

}  // namespace

std::optional<std::array<double, 2>> TracedRay::at_plane(double z_mm) const {
    if (status != RayStatus::Passed || direction.z == 0) return std::nullopt;
    const double t = (z_mm - point.z) / direction.z;
    // A film may be moved to before the last glass's rim; a ray that leads away from it is lost.
    if (direction.z < 0 && t < 0) return std::nullopt;
    return std::array{point.x + t * direction.x, point.y + t * direction.y};
}

TracedRay trace_ray(const Lens& lens, const V3d& origin_mm, const V3d& direction, double nm,
                    Towards towards, Clip clip) {
    const int begin = towards == Towards::Film ? 0 : lens.last();
    LensRay<d4> ray;
    ray.counted_from = begin;
    ray.origin = in_all_lanes(origin_mm - V3d(0, 0, lens.vertex_mm(begin)));
    ray.direction = in_all_lanes(direction.normalized());
    TracedRay out;
    const auto observe = [&](const LensHit<d4>& hit) {
        if (!hit.reached[0]) return;
        out.points.push_back(first_lane(hit.point) + V3d(0, 0, lens.vertex_mm(hit.surface)));
        out.path_mm += hit.index[0] * hit.distance_mm[0];
    };
    static_cast<void>(trace_lens({lens, towards, SurfaceRange{0, lens.last()}, clip},
                                 lens.exact_indices(broadcast<d4>(nm)), ray, observe));
    out.status = ray.status(0);
    if (out.status != RayStatus::Passed) {
        out.end_surface = static_cast<int>(ray.end_surface[0]);
        return out;
    }
    out.point = first_lane(ray.origin) + V3d(0, 0, lens.vertex_mm(ray.counted_from));
    out.direction = first_lane(ray.direction);
    return out;
}

}  // namespace petzval
