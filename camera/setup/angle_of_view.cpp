// SPDX-License-Identifier: Apache-2.0
#include "camera/setup/angle_of_view.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "camera/bench/analysis.h"
#include "camera/bench/lens_scale.h"
#include "camera/lens/focus.h"

namespace petzval::camera {
namespace {

constexpr double kDistant_mm = -std::numeric_limits<double>::infinity();

}  // namespace

float angle_of_view_rad(const Lens& lens, float film_height_mm, double focal_length_mm) {
    const double half_mm = 0.5 * double(film_height_mm);
    if (const auto distant = focused(lens, kDistant_mm))
        if (const auto deg = field_of_height_deg(*distant, half_mm, distant->film_mm()))
            return static_cast<float>(2 * *deg * std::numbers::pi / 180);
    return static_cast<float>(2 * std::atan(half_mm / focal_length_mm));
}

std::optional<Lens> scaled_to_view(const Lens& lens, float film_height_mm, float yfov_rad) {
    const auto distant = focused(lens, kDistant_mm);
    if (!distant) return std::nullopt;
    const double half_deg = double(yfov_rad) / 2 * 180 / std::numbers::pi;
    const auto factor =
        scale_for_field(*distant, double(film_height_mm) / 2, half_deg, distant->film_mm());
    if (!factor) return std::nullopt;
    return Lens(scaled(lens.prescription(), *factor));
}

}  // namespace petzval::camera
