// SPDX-License-Identifier: Apache-2.0
#include "camera/waves/reference_sphere.h"

#include <cmath>

#include "camera/bench/spot.h"
#include "camera/lens/trace.h"

namespace petzval::camera {
namespace {

double rim_mm(const Lens& lens) {
    return lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm;
}

// Curvature of the sphere through the middle of the exit pupil, or 0 where rays that miss the
// image point by reach_mm would come near its edge.
double curvature_of(const AimedBundle& bundle, double film_mm, std::array<double, 2> image_mm,
                    double reach_mm) {
    constexpr double most = 0.2;  // of reach over radius
    const Lens& lens = bundle.lens();
    const double pupil_mm = lens.vertex_mm(lens.last()) +
                            first_order(lens, bundle.nm(), bundle.object().section).exit_pupil_mm;
    if (!std::isfinite(pupil_mm)) return 0;
    const double radius_mm = std::hypot(image_mm[0], image_mm[1], film_mm - pupil_mm);
    if (!(reach_mm <= most * radius_mm)) return 0;
    return (film_mm < pupil_mm ? -1 : 1) / radius_mm;
}

}  // namespace

// A ray that passes the centre at a distance h meets the sphere of radius R about it a way of
// sqrt(R^2 - h^2) before it is nearest to the centre. Against R that is h^2 / (R + sqrt(R^2 -
// h^2)), where nothing cancels and R may be infinite.
template <class N>
ReferenceRay<N> meet_reference(const AimedBundle& bundle, const ReferenceSphere& sphere, N sagittal,
                               N tangential) {
    const Lens& lens = bundle.lens();
    const BundlePassage<N> passage = bundle.pass<N>(sagittal, tangential, Clip::No);
    const Vec3<N>&o = passage.ray.origin, &d = passage.ray.direction;
    const double to_film_mm = sphere.film_mm - lens.vertex_mm(lens.last()),
                 c = sphere.curvature_1_mm;
    const N to_film = (to_film_mm - o.z) / d.z;
    const N x = o.x + d.x * to_film - sphere.image_mm[0];
    const N y = o.y + d.y * to_film - sphere.image_mm[1];
    const N along = x * d.x + y * d.y;
    const Vec3<N> off{x - along * d.x, y - along * d.y, -along * d.z};
    const N h2 = dot(off, off);
    const N cosine = sqrt(lens_trace::or_zero(N(1 - h2 * (c * c))));
    ReferenceRay<N> out;
    out.p = (d.x * cosine - off.x * c) * sphere.index;
    out.q = (d.y * cosine - off.y * c) * sphere.index;
    const auto way_mm =
        value_of(to_film) - value_of(along) + value_of(h2) * c / (1 + value_of(cosine));
    out.opd_mm = sphere.chief_path_mm - (passage.path_mm + sphere.index * way_mm);
    const double radius_mm = rim_mm(lens);
    out.stop_x = passage.stop_x / radius_mm;
    out.stop_y = passage.stop_y / radius_mm;
    out.inside = passage.inside;
    out.passed = passage.passed;
    return out;
}
template ReferenceRay<d4> meet_reference(const AimedBundle&, const ReferenceSphere&, d4, d4);
template ReferenceRay<Dual<d4>> meet_reference(const AimedBundle&, const ReferenceSphere&, Dual<d4>,
                                               Dual<d4>);

ReferenceSphere reference_sphere(const AimedBundle& bundle, double film_mm,
                                 std::array<double, 2> image_mm) {
    constexpr int side = 32;
    ReferenceSphere out{.film_mm = film_mm, .image_mm = image_mm, .index = bundle.film_index()};
    // Rays beyond the rims may land anywhere, and some wavelengths have more of them.
    double reach_mm = 0;
    for (const BundleRay& ray : bundle.trace(bundle.grid(side), film_mm))
        reach_mm = std::max(reach_mm,
                            std::hypot(ray.film_mm[0] - image_mm[0], ray.film_mm[1] - image_mm[1]));
    out.curvature_1_mm = curvature_of(bundle, film_mm, image_mm, reach_mm);
    const PupilPoint chief = bundle.chief();
    out.chief_path_mm =
        -meet_reference<d4>(bundle, out, broadcast<d4>(chief[0]), broadcast<d4>(chief[1]))
             .opd_mm[0];
    return out;
}

std::optional<std::array<double, 2>> image_point(const AimedBundle& bundle, double film_mm) {
    constexpr int side = 64;
    const auto rays = bundle.trace(bundle.grid(side), film_mm);
    if (rays.empty()) return std::nullopt;
    return spot_size(rays).centroid_mm;
}

std::vector<OpdPoint> opd_fan(const AimedBundle& bundle, const ReferenceSphere& sphere,
                              Section along, int count) {
    const size_t moves = along == bundle.object().section ? 1 : 0;
    std::vector<OpdPoint> out;
    for (int i = 0; i < count; ++i) {
        PupilPoint at = bundle.chief();
        at[moves] = bundle.least()[moves] +
                    (bundle.most()[moves] - bundle.least()[moves]) * i / (count - 1);
        const auto ray =
            meet_reference<d4>(bundle, sphere, broadcast<d4>(at[0]), broadcast<d4>(at[1]));
        const double x = ray.stop_x[0], y = ray.stop_y[0];
        if (ray.passed[0] && ray.inside[0] >= 0 && std::hypot(x, y) <= 1)
            out.push_back({along == Section::X ? x : y, ray.opd_mm[0]});
    }
    return out;
}

}  // namespace petzval::camera
