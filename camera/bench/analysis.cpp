// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/analysis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/lens/traced_ray.h"
#include "camera/models/lens_camera.h"

namespace petzval::camera {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Position of the object's plane, from the first vertex.
double object_mm(const Lens& lens, double distance_mm, Section section) {
    return first_order(lens, kLineD_nm, section).entrance_pupil_mm - distance_mm;
}

/// Section whose focal length is nearer to the stated one.
Section stated_section(const Lens& lens) {
    const auto stated_mm = lens.prescription().stated_focal_length_mm;
    if (!stated_mm || lens.of_revolution()) return Section::Y;
    const auto off_mm = [&](Section section) {
        return std::fabs(first_order(lens, kLineD_nm, section).focal_length_mm - *stated_mm);
    };
    return off_mm(Section::X) < off_mm(Section::Y) ? Section::X : Section::Y;
}

}  // namespace

std::optional<double> chief_height_mm(const Lens& lens, const ObjectPoint& object, double film_mm,
                                      double nm) {
    const auto bundle = AimedBundle::aim(lens, object, nm);
    if (!bundle) return std::nullopt;
    const PupilPoint chief = bundle->chief();
    const auto rays = bundle->trace({&chief, 1}, film_mm, Clip::No);
    if (rays.empty()) return std::nullopt;
    return rays[0].film_mm[object.section == Section::X ? 0 : 1];
}

std::optional<double> field_half_deg(const Prescription& lens) {
    if (lens.stated_field_half_deg) return lens.stated_field_half_deg;
    if (!(lens.image_circle_mm > 0)) return std::nullopt;
    const double focal_length_mm =
        lens.stated_focal_length_mm.value_or(first_order(Lens(lens), kLineD_nm).focal_length_mm);
    return std::atan(lens.image_circle_mm / 2 / std::fabs(focal_length_mm)) / kDegree;
}

std::optional<Distortion> distortion(const Lens& lens, double field_deg, double film_mm,
                                     double distance_mm, Section section) {
    const auto height = chief_height_mm(lens, {field_deg, distance_mm, section}, film_mm);
    if (!height) return std::nullopt;
    const double tangent = std::tan(field_deg * kDegree);
    const double scale_mm =
        std::isfinite(distance_mm)
            ? -image_of(lens, object_mm(lens, distance_mm, section), kLineD_nm, section)
                      .magnification *
                  distance_mm
            : first_order(lens, kLineD_nm, section).focal_length_mm;
    return Distortion{field_deg, *height, scale_mm * tangent};
}

// Traced from the film backwards: the secant method finds the ray of a film point through the
// middle of the stop. It begins near the axis with the paraxial one and follows it outwards, as
// aspheres lead it far from there.
std::optional<double> field_of_height_deg(const Lens& lens, double height_mm, double film_mm,
                                          Section section) {
    constexpr double last_deg = 120, close_mm = 1e-10;
    constexpr int steps = 8, tries = 50;
    const bool along_x = section == Section::X;
    const auto trace = [&](double from_mm, double slope) {
        const V3d from = along_x ? V3d(from_mm, 0, film_mm) : V3d(0, from_mm, film_mm);
        const V3d direction = along_x ? V3d(slope, 0, -1) : V3d(0, slope, -1);
        return trace_ray(lens, from, direction, kLineD_nm, Towards::Scene, Clip::No);
    };
    const auto miss_of = [&](const TracedRay& ray) {
        const auto met = static_cast<size_t>(lens.last() - lens.stop());
        if (ray.points.size() <= met) return double{NAN};
        return along_x ? ray.points[met].x : ray.points[met].y;
    };
    const double to_pupil_mm =
        film_mm - lens.vertex_mm(lens.last()) - first_order(lens, kLineD_nm, section).exit_pupil_mm;
    double slope_by_mm = -1 / to_pupil_mm;
    TracedRay ray;
    for (int step = 1; step <= steps; ++step) {
        const double from_mm = height_mm * step / steps;
        double before = from_mm * slope_by_mm * 0.99, slope = from_mm * slope_by_mm;
        double miss_before = miss_of(trace(from_mm, before));
        for (int i = 0;; ++i) {
            ray = trace(from_mm, slope);
            const double miss = miss_of(ray);
            if (std::fabs(miss) < close_mm) break;
            if (!std::isfinite(miss) || i == tries) return std::nullopt;
            const double next = slope - miss * (slope - before) / (miss - miss_before);
            before = slope;
            miss_before = miss;
            slope = next;
        }
        slope_by_mm = slope / from_mm;
    }
    if (ray.status != RayStatus::Passed) return std::nullopt;
    const double deg = std::acos(-ray.direction.z) / kDegree;
    return deg <= last_deg ? std::optional(deg) : std::nullopt;
}

std::vector<double> film_irradiance(std::shared_ptr<const Lens> lens, double film_mm,
                                    const std::vector<double>& heights_mm, Section section) {
    const double radius =
        lens->prescription().surfaces[static_cast<size_t>(lens->stop())].semi_diameter_mm;
    LensCameraInput in{.lens = lens, .iris = Iris(Disk{}, radius), .to_world = M44f()};
    in.film_mm = film_mm;
    in.entrance_pupil_mm = first_order(*lens, kLineD_nm).entrance_pupil_mm;
    // The diagonal reaches as far as the heights do.
    double reach = 1e-3;
    for (const double height : heights_mm) reach = std::max(reach, std::fabs(height));
    in.film_width_mm = in.film_height_mm = reach * std::numbers::sqrt2;
    const LensCamera camera(std::move(in));
    std::vector<double> out;
    for (const double height : heights_mm) {
        V2f film(0.f);
        (section == Section::X ? film.x : film.y) = static_cast<float>(height);
        out.push_back(camera.irradiance(film, 1 << 14));
    }
    return out;
}

std::vector<StatedFigure> stated_figures(const Lens& lens) {
    const Prescription& file = lens.prescription();
    const FirstOrder first = first_order(lens, kLineD_nm, stated_section(lens));
    std::vector<StatedFigure> out;
    if (file.stated_focal_length_mm)
        out.push_back({"focal length (mm)", *file.stated_focal_length_mm, first.focal_length_mm});
    if (file.stated_fnumber)
        out.push_back({"f-number (paraxial)", *file.stated_fnumber, first.fnumber});
    out.push_back({"film behind the last vertex (mm)", file.surfaces.back().thickness_mm,
                   first.back_focus_mm});
    return out;
}

FieldAndCircle field_and_circle(const Lens& lens) {
    const Prescription& file = lens.prescription();
    const Section section = stated_section(lens);
    FieldAndCircle out;
    out.half_field_deg = file.stated_field_half_deg;
    if (out.half_field_deg)
        if (const auto height_mm = chief_height_mm(
                lens, {.field_deg = *out.half_field_deg, .section = section}, lens.film_mm()))
            out.circle_of_half_field_mm = 2 * std::fabs(*height_mm);
    if (file.image_circle_mm > 0) {
        out.image_circle_mm = file.image_circle_mm;
        out.half_field_of_image_circle_deg =
            field_of_height_deg(lens, file.image_circle_mm / 2, lens.film_mm(), section);
    }
    return out;
}

}  // namespace petzval::camera
