// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/ray_path.h"

#include "camera/lens/traced_ray.h"

namespace petzval::camera {

std::vector<PupilPoint> section_points(const AimedBundle& bundle, int count) {
    std::vector<PupilPoint> out(size_t(count), bundle.chief());
    if (count == 1) return out;
    constexpr size_t tangential = 1;
    const double least = bundle.least()[tangential], most = bundle.most()[tangential];
    // The box has a margin; the outermost rays should pass.
    for (int i = 0; i < count; ++i)
        out[size_t(i)][tangential] = least + (most - least) * (0.04 + 0.92 * i / (count - 1));
    return out;
}

Outline ray_path(const Lens& lens, const AimedBundle& bundle, PupilPoint pupil_point,
                 double film_mm, double lead_mm) {
    const size_t axis = bundle.object().section == Section::X ? 0 : 1;
    const AimedBundle::Line line = bundle.line(pupil_point);
    const TracedRay ray =
        trace_ray(lens, line.origin_mm, line.direction, bundle.nm(), Towards::Film, Clip::Yes);
    const auto height = [axis](const V3d& p) { return axis == 0 ? p.x : p.y; };
    const V3d first = ray.points.empty() ? line.origin_mm : ray.points.front();
    const V3d start = first - line.direction * lead_mm;
    Outline out{{start.z, height(start)}};
    for (const V3d& p : ray.points) out.push_back({p.z, height(p)});
    if (const auto film = ray.at_plane(film_mm)) out.push_back({film_mm, (*film)[axis]});
    return out;
}

}  // namespace petzval::camera
