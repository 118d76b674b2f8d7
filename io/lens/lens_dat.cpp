// SPDX-License-Identifier: Apache-2.0
// pbrt's lens descriptions (Pharr, Jakob, Humphreys 2016, Physically Based Rendering, 6.4): a
// line for each surface from the scene to the film, of radius, thickness, index behind it and
// diameter in mm; # begins a comment. Radius 0: the stop, or a plane of glass; index 0 or 1: air.
#include <fmt/format.h>

#include <array>

#include "io/base/error.h"
#include "io/file/text_lines.h"
#include "io/lens/lens_formats.h"

namespace petzval::io {
namespace {

std::array<double, 4> columns(const TextLine& line, const std::vector<std::string>& word,
                              const std::string& file) {
    if (word.size() != 4)
        throw InputError(file, line.place(),
                         "has {} columns; each surface has 4: radius, thickness, index, "
                         "diameter of the aperture, in mm",
                         word.size());
    std::array<double, 4> values{};
    for (size_t i = 0; i < 4; ++i) {
        const auto value = finite_number(word[i]);
        if (!value) throw InputError(file, line.place(), "column {} is not a finite number", i + 1);
        values[i] = *value;
    }
    return values;
}

}  // namespace

LensFile read_lens_dat(std::string_view text, const std::string& file, const std::string& name) {
    LensFile out;
    out.lens.name = name;
    auto& surfaces = out.lens.surfaces;
    std::string stop;
    for (const TextLine& line : text_lines(text, file)) {
        const auto word = words(std::string_view(line.text).substr(0, line.text.find('#')));
        if (word.empty()) continue;
        const auto fail = [&](const std::string& message) {
            return InputError(file, line.place(), message);
        };
        const auto [radius_mm, thickness_mm, stated_index, diameter_mm] = columns(line, word, file);
        const double index = stated_index < 1 && stated_index > 0.998 ? 1 : stated_index;  // air
        camera::LensSurface surface;
        surface.curvature_1_mm = radius_mm == 0 ? 0 : 1 / radius_mm;
        surface.thickness_mm = thickness_mm;
        surface.semi_diameter_mm = diameter_mm / 2;
        if (const auto fault = fault_of(surface)) throw fail(*fault);
        if (index != 0 && !(index >= 1 && index <= 5))
            throw fail(
                fmt::format("has the index {}; it must be 0 for air, or from 1 to 5", index));
        if (index > 1) surface.glass = constant_glass(index);
        const bool air_before = surfaces.empty() || !surfaces.back().glass;
        surface.stop = radius_mm == 0 && air_before && !surface.glass;
        if (surface.stop && !stop.empty())
            throw fail(
                fmt::format("is a second stop (radius 0 in air); that at {} is one already", stop));
        if (surface.stop) stop = line.place();
        surfaces.push_back(std::move(surface));
    }
    if (stop.empty())
        throw InputError(file, "", "has no stop; give the plane of the iris as a line of radius 0");
    out.warnings.push_back(file + ": has one index for each glass, so the lens has no dispersion");
    return out;
}

}  // namespace petzval::io
