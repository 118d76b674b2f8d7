// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/aimed_bundle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/lens/trace.h"

namespace petzval::camera {
namespace {

constexpr double kTolerance = 1e-9;  // of the stop's radius
constexpr int kMostSteps = 30, kMostHalvings = 8;

double stop_radius_mm(const Lens& lens) {
    return lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm;
}

}  // namespace

AimedBundle::AimedBundle(const Lens& lens, const ObjectPoint& object, double nm)
    : lens_(&lens),
      object_(object),
      nm_(nm),
      entrance_pupil_mm_(first_order(lens, kLineD_nm, object.section).entrance_pupil_mm),
      indices_(lens.exact_indices(broadcast<d4>(nm))) {
    // A lens that is telecentric on the side of the scene has its pupil at infinity: any plane
    // does.
    if (!(std::fabs(entrance_pupil_mm_) < 1e6)) entrance_pupil_mm_ = 0;
}

template <class N>
LensRay<N> AimedBundle::launched(N sagittal, N tangential) const {
    const double angle = object_.field_deg * std::numbers::pi / 180;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const auto number = [](double a) { return constant<N>(broadcast<ValueOf<N>>(a)); };
    // Coordinates as if the section were y-z: along it, and down the axis.
    const N along = tangential * cosine;
    const N z = tangential * -sine;
    LensRay<N> ray;
    Vec3<N> direction{number(0), number(sine), number(cosine)};
    if (std::isfinite(object_.distance_mm)) {
        direction = {sagittal, along + object_.distance_mm * sine / cosine,
                     z + object_.distance_mm};
        direction = direction * (1 / sqrt(dot(direction, direction)));
    }
    ray.origin = {sagittal, along, z + entrance_pupil_mm_};
    ray.direction = direction;
    if (object_.section == Section::X) {
        std::swap(ray.origin.x, ray.origin.y);
        std::swap(ray.direction.x, ray.direction.y);
    }
    return ray;
}

// Newton's method with the trace's own derivatives.
std::optional<PupilPoint> AimedBundle::solve(std::array<double, 2> stop_mm,
                                             PupilPoint guess) const {
    using D = Dual<d4>;
    const double tolerance_mm = kTolerance * stop_radius_mm(*lens_);
    PupilPoint at = guess, good = guess, step{};
    int halvings = 0;
    for (int i = 0; i < kMostSteps; ++i) {
        auto ray = launched<D>({broadcast<d4>(at[0]), broadcast<d4>(1), d4{}},
                               {broadcast<d4>(at[1]), d4{}, broadcast<d4>(1)});
        const auto passed =
            trace_lens<D>({*lens_, Towards::Film, {0, lens_->stop()}, Clip::No}, indices_, ray);
        if (!passed[0]) {  // too far: rays there never reach the stop
            if (++halvings > kMostHalvings) return std::nullopt;
            for (size_t k = 0; k < 2; ++k) at[k] = good[k] + (step[k] *= 0.5);
            continue;
        }
        const D &x = ray.origin.x, &y = ray.origin.y;
        const double off_x = stop_mm[0] - x.value[0], off_y = stop_mm[1] - y.value[0];
        if (std::hypot(off_x, off_y) <= tolerance_mm) return at;
        const double a = x.du[0], b = x.dv[0], c = y.du[0], d = y.dv[0];
        const double determinant = a * d - b * c;
        if (!(std::fabs(determinant) > 0)) return std::nullopt;
        good = at;
        step = {(d * off_x - b * off_y) / determinant, (a * off_y - c * off_x) / determinant};
        for (size_t k = 0; k < 2; ++k) at[k] += step[k];
    }
    return std::nullopt;
}

std::optional<AimedBundle> AimedBundle::aim(const Lens& lens, const ObjectPoint& object,
                                            double nm) {
    // Entrance pupils of wide-angle lenses move with the field: each ray begins at one that is
    // near.
    for (const double step_deg : {2., 0.25}) {
        const int steps = std::max(1, static_cast<int>(std::ceil(object.field_deg / step_deg)));
        std::optional<PupilPoint> chief = PupilPoint{};
        AimedBundle bundle(lens, object, nm);
        for (int i = 1; i <= steps && chief; ++i) {
            bundle.object_.field_deg = object.field_deg * i / steps;
            chief = bundle.solve({}, *chief);
        }
        if (!chief) continue;
        bundle.object_ = object;
        bundle.chief_ = *chief;
        bundle.find_box();
        return bundle;
    }
    return std::nullopt;
}

void AimedBundle::find_box() {
    constexpr int directions = 32, steps = 4;
    constexpr double margin = 0.02;  // more than the rim may bulge between two directions
    least_ = most_ = chief_;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2 * std::numbers::pi * i / directions;
        PupilPoint before = chief_, at = chief_;
        for (int k = 1; k <= steps; ++k) {
            const double r = stop_radius_mm(*lens_) * k / steps;
            const PupilPoint guess{2 * at[0] - before[0], 2 * at[1] - before[1]};
            const auto next = solve({r * std::cos(angle), r * std::sin(angle)}, guess);
            if (!next) break;
            before = at;
            at = *next;
            for (size_t j = 0; j < 2; ++j) {
                least_[j] = std::min(least_[j], at[j]);
                most_[j] = std::max(most_[j], at[j]);
            }
        }
    }
    for (size_t j = 0; j < 2; ++j) {
        const double more = margin * (most_[j] - least_[j]);
        least_[j] -= more;
        most_[j] += more;
    }
}

AimedBundle::Line AimedBundle::line(PupilPoint pupil_point) const {
    const auto ray = launched<d4>(broadcast<d4>(pupil_point[0]), broadcast<d4>(pupil_point[1]));
    return {V3d(ray.origin.x[0], ray.origin.y[0], ray.origin.z[0]),
            V3d(ray.direction.x[0], ray.direction.y[0], ray.direction.z[0])};
}

template <class N>
BundlePassage<N> AimedBundle::pass(N sagittal, N tangential, Clip clip) const {
    using V = ValueOf<N>;
    BundlePassage<N> out;
    out.ray = launched<N>(sagittal, tangential);
    if (std::isfinite(object_.distance_mm)) {  // where the wave is a sphere
        const double to_object_mm =
            object_.distance_mm / std::cos(object_.field_deg * std::numbers::pi / 180);
        const V s = value_of(sagittal), t = value_of(tangential), r2 = s * s + t * t;
        out.path_mm = r2 / (to_object_mm + sqrt(to_object_mm * to_object_mm + r2));
    }
    const SurfaceFacts<double>* const facts = lens_->surfaces<double>().data();
    const auto observe = [&](const LensHit<V>& hit) {
        out.path_mm += select(hit.reached, hit.index * hit.distance_mm, V{});
        if (hit.surface == lens_->stop()) {
            out.stop_x = hit.point.x;
            out.stop_y = hit.point.y;
            return;
        }
        const V inside = 1 - (hit.point.x * hit.point.x + hit.point.y * hit.point.y) /
                                 facts[hit.surface].semi_diameter2_mm2;
        out.inside = select(inside < out.inside, inside, out.inside);
    };
    const auto alive = trace_lens<N>({*lens_, Towards::Film, {0, lens_->last()}, clip}, indices_,
                                     out.ray, observe);
    out.passed = alive & (value_of(out.ray.direction.z) > 0);
    return out;
}
template BundlePassage<d4> AimedBundle::pass(d4, d4, Clip) const;
template BundlePassage<Dual<d4>> AimedBundle::pass(Dual<d4>, Dual<d4>, Clip) const;

std::vector<BundleRay> AimedBundle::trace(std::span<const PupilPoint> pupil_points, double film_mm,
                                          Clip clip) const {
    std::vector<BundleRay> out;
    const double to_film_mm = film_mm - lens_->vertex_mm(lens_->last());
    const double index = film_index();
    for (size_t first = 0; first < pupil_points.size(); first += 4) {
        const size_t count = std::min<size_t>(4, pupil_points.size() - first);
        d4 sagittal{}, tangential{};
        for (int i = 0; i < 4; ++i) {
            const PupilPoint& pupil_point = pupil_points[first + std::min(size_t(i), count - 1)];
            sagittal[i] = pupil_point[0];
            tangential[i] = pupil_point[1];
        }
        const BundlePassage<d4> passage = pass<d4>(sagittal, tangential, clip);
        const LensRay<d4>& ray = passage.ray;
        for (int i = 0; i < static_cast<int>(count); ++i) {
            if (!passage.passed[i]) continue;
            const double slope_x = ray.direction.x[i] / ray.direction.z[i];
            const double slope_y = ray.direction.y[i] / ray.direction.z[i];
            const double dz = to_film_mm - ray.origin.z[i];
            out.push_back({pupil_points[first + size_t(i)],
                           {passage.stop_x[i], passage.stop_y[i]},
                           {ray.origin.x[i] + slope_x * dz, ray.origin.y[i] + slope_y * dz},
                           {slope_x, slope_y},
                           passage.path_mm[i] + index * dz / ray.direction.z[i]});
        }
    }
    return out;
}

double AimedBundle::film_index() const {
    return indices_.of_medium[lens_->surfaces<double>().back().medium_after][0];
}

std::vector<PupilPoint> AimedBundle::grid(int side) const {
    std::vector<PupilPoint> out;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            out.push_back({least_[0] + (most_[0] - least_[0]) * (i + 0.5) / side,
                           least_[1] + (most_[1] - least_[1]) * (j + 0.5) / side});
    return out;
}

}  // namespace petzval::camera
