// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/traced_ray.h"

#include <algorithm>
#include <limits>

#include "camera/lens/trace.h"

namespace petzval::camera {
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

void trace_rays(const Lens& lens, const RaysIn& in, Towards towards, Clip clip,
                const RaysOut& out) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const int begin = towards == Towards::Film ? 0 : lens.last();
    const double begin_mm = lens.vertex_mm(begin);
    const size_t count = in.origins_mm.size();
    d4 nm = broadcast<d4>(in.nm.empty() ? kLineD_nm : in.nm[0]);
    LensIndices<d4> indices = lens.exact_indices(nm);
    for (size_t first = 0; first < count; first += 4) {
        LensRay<d4> ray;
        ray.counted_from = begin;
        d4 wanted_nm = nm;
        for (size_t k = 0; k < 4; ++k) {
            const size_t i = std::min(first + k, count - 1);
            const V3d& origin = in.origins_mm[i];
            const V3d direction = in.directions[i].normalized();
            ray.origin.x[k] = origin.x, ray.origin.y[k] = origin.y;
            ray.origin.z[k] = origin.z - begin_mm;
            ray.direction.x[k] = direction.x, ray.direction.y[k] = direction.y;
            ray.direction.z[k] = direction.z;
            if (in.nm.size() > 1) wanted_nm[k] = in.nm[i];
        }
        if (!all(wanted_nm == nm)) indices = lens.exact_indices(nm = wanted_nm);
        d4 path_mm{};
        const auto observe = [&](const LensHit<d4>& hit) {
            path_mm += select(hit.reached, hit.index * hit.distance_mm, d4{});
        };
        const auto passed =
            trace_lens({lens, towards, SurfaceRange{0, lens.last()}, clip}, indices, ray, observe);
        const double end_mm = lens.vertex_mm(ray.counted_from);
        for (size_t k = 0; k < 4 && first + k < count; ++k) {
            const size_t i = first + k;
            const bool on = passed[k] != 0;
            out.status[i] = ray.status(int(k));
            out.end_surfaces[i] = on ? -1 : int(ray.end_surface[k]);
            out.paths_mm[i] = on ? path_mm[k] : kNone;
            out.points_mm[i] =
                on ? V3d(ray.origin.x[k], ray.origin.y[k], ray.origin.z[k] + end_mm) : V3d(kNone);
            out.directions[i] =
                on ? V3d(ray.direction.x[k], ray.direction.y[k], ray.direction.z[k]) : V3d(kNone);
        }
    }
}

}  // namespace petzval::camera
