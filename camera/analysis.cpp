// SPDX-License-Identifier: Apache-2.0
#include "camera/analysis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/lens_camera.h"

namespace petzval {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Of the object's plane, from the first vertex.
double object_mm(const Lens& lens, double distance_mm, Section section) {
    return first_order(lens, kLineD_nm, section).entrance_pupil_mm - distance_mm;
}

}  // namespace

std::optional<double> chief_height_mm(const Lens& lens, const ObjectPoint& object, double film_mm) {
    const auto beam = Beam::aim(lens, object, kLineD_nm);
    if (!beam) return std::nullopt;
    const Launch chief = beam->chief();
    const auto rays = beam->trace({&chief, 1}, film_mm, Clip::No);
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

// Heights grow with the angle as far as a lens is used: halving.
std::optional<double> field_of_height_deg(const Lens& lens, double height_mm, double film_mm,
                                          Section section) {
    constexpr double last_deg = 120, step_deg = 2;
    const auto over = [&](double deg) {
        return chief_height_mm(lens, {.field_deg = deg, .section = section}, film_mm)
                   .value_or(NAN) -
               height_mm;
    };
    double low = 0, high = 0;
    do {
        low = high;
        high += step_deg;
        if (high > last_deg || std::isnan(over(high))) return std::nullopt;
    } while (over(high) < 0);
    while (high - low > 1e-9) {
        const double middle = (low + high) / 2;
        (over(middle) < 0 ? low : high) = middle;
    }
    return (low + high) / 2;
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
        out.push_back(camera.irradiance(film, 128));
    }
    return out;
}

std::vector<StatedFigure> stated_figures(const Lens& lens) {
    const Prescription& file = lens.prescription();
    Section section = Section::Y;
    FirstOrder first = first_order(lens, kLineD_nm);
    if (file.stated_focal_length_mm) {
        const FirstOrder other = first_order(lens, kLineD_nm, Section::X);
        const auto off = [&](const FirstOrder& data) {
            return std::fabs(data.focal_length_mm - *file.stated_focal_length_mm);
        };
        if (off(other) < off(first)) {
            first = other;
            section = Section::X;
        }
    }
    std::vector<StatedFigure> out;
    if (file.stated_focal_length_mm)
        out.push_back({"focal length (mm)", *file.stated_focal_length_mm, first.focal_length_mm});
    if (file.stated_fnumber) out.push_back({"f-number", *file.stated_fnumber, first.fnumber});
    if (file.stated_field_half_deg && file.image_circle_mm > 0)
        out.push_back({"half field (degrees)", *file.stated_field_half_deg,
                       field_of_height_deg(lens, file.image_circle_mm / 2, lens.film_mm(), section)
                           .value_or(NAN)});
    out.push_back({"film behind the last vertex (mm)", file.surfaces.back().thickness_mm,
                   first.back_focus_mm});
    return out;
}

}  // namespace petzval
