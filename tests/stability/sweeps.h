// SPDX-License-Identifier: Apache-2.0
// The sweeps of the map of failures, and what they share.
#pragma once

#include <cmath>
#include <exception>
#include <optional>
#include <string>
#include <type_traits>

#include "core/sampling/sampler.h"
#include "tests/stability/stability.h"

namespace petzval::stability {

/// Three digits.
[[nodiscard]] std::string number(double);
/// The same, or "none" for what a sweep did not find.
[[nodiscard]] inline std::string number(const std::optional<double>& a) {
    return a ? number(*a) : "none";
}
/// A share as "0.3 %".
[[nodiscard]] std::string percent(double share);

/// A row of a table, numbers as number() has them.
template <class... Cells>
[[nodiscard]] std::vector<std::string> row(const Cells&... cells) {
    const auto text = [](const auto& cell) -> std::string {
        if constexpr (std::is_convertible_v<decltype(cell), std::string>)
            return cell;
        else
            return number(cell);
    };
    return {text(cells)...};
}
/// Adds it to the table of a finding.
template <class... Cells>
void add_row(Finding& f, const Cells&... cells) {
    f.table.rows.push_back(row(cells...));
}

/// The parameter at which fails(x) is first true, on geometric steps from one end to the other,
/// then halved until its relative error is below 1e-3; nothing where it never is.
template <class Fails>
[[nodiscard]] std::optional<double> first_failure(double from, double to, const Fails& fails,
                                                  int steps_per_decade = 8) {
    const double decades = std::log10(to / from);
    const int steps = static_cast<int>(std::ceil(std::fabs(decades) * steps_per_decade));
    double good = from;
    for (int i = 0; i <= steps; ++i) {
        double bad = from * std::pow(10, decades * i / steps);
        if (!fails(bad)) {
            good = bad;
            continue;
        }
        while (i > 0 && std::fabs(std::log(bad / good)) > 1e-3) {
            const double middle = std::sqrt(good * bad);
            (fails(middle) ? bad : good) = middle;
        }
        return bad;
    }
    return std::nullopt;
}

/// What a call says when it refuses; "accepted" where it does not.
template <class Function>
[[nodiscard]] std::string refusal_of(const Function& function) {
    try {
        function();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "accepted";
}

/// Numbers of a sweep: independent ones, each a function of its place.
class Draws {
  public:
    explicit Draws(uint32_t seed) : seed_(seed) {}
    [[nodiscard]] float next() { return to_unit_float(hash32(seed_, count_++)); }
    [[nodiscard]] V2f next2() {
        const float x = next();
        return {x, next()};
    }

  private:
    uint32_t seed_, count_ = 0;
};

[[nodiscard]] Finding third_order_formula();
[[nodiscard]] Finding focus_near_focal_length();
[[nodiscard]] Finding rejection_of_slivers();
[[nodiscard]] Finding degenerate_polygons();
[[nodiscard]] Finding choice_by_weight();
[[nodiscard]] Finding pupil_at_wide_fields();
[[nodiscard]] Finding trace_at_grazing_incidence();
[[nodiscard]] Finding trace_over_long_radii();
[[nodiscard]] Finding newton_on_strong_aspheres();
[[nodiscard]] Finding dispersion_out_of_range();
[[nodiscard]] Finding scene_scale();
[[nodiscard]] Finding camera_far_from_origin();
[[nodiscard]] Finding ggx_energy();
[[nodiscard]] Finding ggx_density();
[[nodiscard]] Finding tiny_sun();
[[nodiscard]] Finding tiny_lamp();
[[nodiscard]] Finding defocused_highlights();
[[nodiscard]] Finding rays_to_targets();
[[nodiscard]] Finding search_for_targets();
[[nodiscard]] Finding planned_noise();
[[nodiscard]] Finding rendered_noise();
[[nodiscard]] Finding denoised_rare_light();
[[nodiscard]] Finding denoised_detail();
[[nodiscard]] Finding chains_of_glass();
[[nodiscard]] Finding nested_volumes();
[[nodiscard]] Finding stacks_of_cards();
[[nodiscard]] Finding many_samples();
[[nodiscard]] Finding film_sums();

/// A sweep, and the identifier of its finding: words with hyphens, which stay when the section of
/// the page gets another name.
struct Sweep {
    const char* id;
    Finding (*run)();
};
/// Every sweep, in the order of the page.
inline constexpr Sweep kSweeps[] = {
    {"third-order-formula", third_order_formula},
    {"focus-near-focal-length", focus_near_focal_length},
    {"rejection-of-slivers", rejection_of_slivers},
    {"degenerate-polygons", degenerate_polygons},
    {"choice-by-weight", choice_by_weight},
    {"pupil-at-wide-fields", pupil_at_wide_fields},
    {"rays-at-grazing-incidence", trace_at_grazing_incidence},
    {"rays-over-long-radii", trace_over_long_radii},
    {"newton-on-strong-aspheres", newton_on_strong_aspheres},
    {"dispersion-out-of-range", dispersion_out_of_range},
    {"scene-scale", scene_scale},
    {"camera-far-from-origin", camera_far_from_origin},
    {"ggx-energy", ggx_energy},
    {"ggx-density", ggx_density},
    {"tiny-sun", tiny_sun},
    {"tiny-lamp", tiny_lamp},
    {"defocused-highlights", defocused_highlights},
    {"rays-to-targets", rays_to_targets},
    {"search-for-targets", search_for_targets},
    {"planned-noise", planned_noise},
    {"rendered-noise", rendered_noise},
    {"denoised-rare-light", denoised_rare_light},
    {"denoised-detail", denoised_detail},
    {"chains-of-glass", chains_of_glass},
    {"nested-volumes", nested_volumes},
    {"stacks-of-cards", stacks_of_cards},
    {"many-samples", many_samples},
    {"film-sums", film_sums},
};

}  // namespace petzval::stability
