// SPDX-License-Identifier: Apache-2.0
// Prescriptions that are meant to break something: edges of what a lens file may say, and beyond.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <optional>

#include "tests/support/random_lens.h"

namespace petzval::test {

[[nodiscard]] inline double one_of(Random& random, std::initializer_list<double> numbers) {
    return numbers.begin()[size_t(random.next() * float(numbers.size()))];
}
[[nodiscard]] inline bool by_chance(Random& random, float chance) {
    return random.next() < chance;
}
/// Of any sign and any size from 10^-300 to 10^300.
[[nodiscard]] inline double any_number(Random& random) {
    const double sign = one_of(random, {-1, 1});
    return sign * std::pow(10, between(random, -300, 300));
}

/// Glass hardly or not at all denser than air, far too dense, with a pole in the visible or right
/// at line d, or with a formula that leads to no index.
[[nodiscard]] inline Glass nasty_glass(Random& random) {
    const double d2_um2 = kLineD_nm * kLineD_nm * 1e-6;
    switch (int(random.next() * 6)) {
        case 0:
            return constant_glass(one_of(random, {1, 1 + 1e-15, 1 + 1e-12, 1 + 1e-7, 1 - 1e-7}));
        case 1:
            return constant_glass(one_of(random, {5, 0.5, 1e-3, 0, -1, -1.5, 1e6}));
        case 2:
            return {
                "pole",
                Sellmeier{{{1, by_chance(random, 0.5f) ? d2_um2 : between(random, 0.12, 0.7)}}}};
        case 3:
            return {"one point", IndexTable{{{550, between(random, 1, 2)}}}, 550, 550};
        case 4: {
            const double nd = between(random, 1, 3);
            return {"modelled", glass_like(nd, between(random, 1, 100))};
        }
        default:
            return {"negative square", PowerSeries{{{between(random, -2, 3), 0}, {-1, 2}}}};
    }
}

/// before: the surface in front; nullptr for the first.
[[nodiscard]] inline camera::LensSurface nasty_surface(Random& random,
                                                       const camera::LensSurface* before) {
    camera::LensSurface out = random_surface(random);
    const double sign = one_of(random, {-1, 1});
    if (by_chance(random, 0.4f))
        out.curvature_1_mm =
            sign / one_of(random, {1e-4, 1e-3, 0.1, 1, 1e6, 1e9, 1e12, 1e15, 1e30});
    if (by_chance(random, 0.1f)) out.curvature_1_mm = sign * 0.0;
    if (before && before->curvature_1_mm != 0 && by_chance(random, 0.2f)) {
        const double radius_mm = 1 / before->curvature_1_mm - before->thickness_mm;
        if (radius_mm != 0) out.curvature_1_mm = 1 / radius_mm;  // concentric
    }
    if (by_chance(random, 0.3f))
        out.conic = one_of(random, {-1, -1 - 1e-15, -1 + 1e-12, -2, 1e3, -1e3, 1e9, -1e9});
    if (by_chance(random, 0.2f)) {
        const int power = 2 + int(random.next() * 39);
        const double at_8_mm = one_of(random, {1, 1e3, 1e6, 1e12, 1e30, 1e150, 1e290, 1e-30});
        out.asphere.push_back({double(power), sign * at_8_mm * std::pow(8, -power)});
    }
    if (by_chance(random, 0.05f)) out.asphere = {{2 + std::floor(39 * random.next()), 0}};
    if (by_chance(random, 0.4f))
        out.thickness_mm = one_of(random, {0, -0., -1e-12, 1e-12, -5, -50, 1e3, 1e5, -1e5});
    if (by_chance(random, 0.3f)) out.semi_diameter_mm = one_of(random, {1e-4, 1e-2, 200, 1e4});
    if (out.curvature_1_mm != 0 && by_chance(random, 0.1f))
        out.semi_diameter_mm = one_of(random, {1, 1.5, 5}) / std::fabs(out.curvature_1_mm);
    if (by_chance(random, 0.3f)) out.glass = nasty_glass(random);
    return out;
}

/// Numbers of any size, where no file may say so.
inline void make_wild(Random& random, camera::LensSurface& surface) {
    for (double* number : {&surface.curvature_1_mm, &surface.conic, &surface.thickness_mm,
                           &surface.semi_diameter_mm})
        if (by_chance(random, 0.3f)) *number = any_number(random);
    if (by_chance(random, 0.3f))
        surface.asphere.push_back({2 + std::floor(39 * random.next()), any_number(random)});
}

/// Half of them have a plane of one medium for a stop, as a lens file must; of the others any
/// surface is the stop. Some stops are closed. wild: some numbers are of any size.
[[nodiscard]] inline camera::Prescription nasty_prescription(Random& random, bool wild) {
    camera::Prescription out;
    const double most = by_chance(random, 0.01f) ? 250 : by_chance(random, 0.1f) ? 40 : 12;
    out.surfaces.resize(1 + size_t(random.next() * most));
    const camera::LensSurface* before = nullptr;
    for (auto& surface : out.surfaces) {
        surface = by_chance(random, 0.5f) ? nasty_surface(random, before) : random_surface(random);
        if (wild && by_chance(random, 0.2f)) make_wild(random, surface);
        before = &surface;
    }
    const auto any_surface = [&] { return size_t(random.next() * float(out.surfaces.size())); };
    const size_t at = any_surface();
    camera::LensSurface& stop = out.surfaces[at];
    stop.stop = true;
    if (by_chance(random, 0.5f)) {
        stop.curvature_1_mm = 0;
        stop.conic = 0;
        stop.asphere.clear();
        stop.profile = camera::Profile::Rotational;
        stop.glass = at > 0 ? out.surfaces[at - 1].glass : std::nullopt;
    }
    if (by_chance(random, 0.05f)) stop.semi_diameter_mm = one_of(random, {0, -0., -1, 1e-30});
    if (by_chance(random, 0.3f)) {
        const int a = int(any_surface()), b = int(any_surface());
        out.focus_group = std::array{std::min(a, b), std::max(a, b)};
    }
    return out;
}

/// As our lens file says it, with as many digits as a double has; what no file may say, such as a
/// formula of a glass, in the same manner.
[[nodiscard]] inline std::string text_of(const camera::Prescription& lens) {
    const auto pairs = [](const auto& terms) {
        std::string out;
        for (const auto& [a, b] : terms)
            out += fmt::format("{}[{}, {}]", out.empty() ? "" : ", ", a, b);
        return out;
    };
    const auto medium = [&](const Glass& glass) {
        const char* const kinds[] = {"sellmeier", "power_series", "index_series", "index_table"};
        const auto terms = std::visit(
            [](const auto& kind) {
                if constexpr (requires { kind.points; })
                    return kind.points;
                else
                    return kind.terms;
            },
            glass.formula);
        if (glass.name == "constant") return fmt::format("{{\"n\": {}}}", terms[0][0]);
        return fmt::format("{{\"{}\": [{}], \"range_nm\": [{}, {}]}}", kinds[glass.formula.index()],
                           pairs(terms), glass.first_nm, glass.last_nm);
    };
    std::string out = "{";
    if (lens.focus_group)
        out += fmt::format("\"focus_group\": [{}, {}],\n ", (*lens.focus_group)[0],
                           (*lens.focus_group)[1]);
    out += "\"surfaces\": [";
    const char* separator = "\n";
    for (const camera::LensSurface& s : lens.surfaces) {
        out += fmt::format(
            "{}  {{\"radius\": {}, \"thickness\": {}, \"medium\": {}, \"semi_diameter\": {}",
            separator, s.curvature_1_mm == 0 ? "null" : fmt::format("{}", 1 / s.curvature_1_mm),
            s.thickness_mm, s.glass ? medium(*s.glass) : "null", s.semi_diameter_mm);
        if (s.conic != 0) out += fmt::format(", \"conic\": {}", s.conic);
        std::string terms;
        for (const auto& [power, a] : s.asphere)
            terms += fmt::format("{}\"{}\": {}", terms.empty() ? "" : ", ", power, a);
        if (!terms.empty()) out += fmt::format(", \"asphere\": {{{}}}", terms);
        if (s.profile != camera::Profile::Rotational)
            out += s.profile == camera::Profile::CylinderX ? ", \"cylinder\": \"x\""
                                                           : ", \"cylinder\": \"y\"";
        if (s.stop) out += ", \"stop\": true";
        out += "}";
        separator = ",\n";
    }
    return out + "\n]}";
}

/// Nasty lens for odd i, random one for even; nothing where the prescription is refused.
[[nodiscard]] inline std::optional<camera::Lens> some_lens(Random& random, int i) {
    try {
        return camera::Lens(i % 2 ? nasty_prescription(random, i % 4 == 1)
                                  : random_prescription(random));
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

}  // namespace petzval::test
