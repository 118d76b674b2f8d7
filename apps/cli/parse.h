// SPDX-License-Identifier: Apache-2.0
// Words of the command line as values. Each throws CLI::ValidationError, which ends with exit
// code 2.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/setup/render_setup.h"
#include "core/film/film.h"
#include "core/spectrum/bins.h"

namespace petzval {

/// "a,b,c": exactly n finite numbers.
[[nodiscard]] std::vector<float> parse_numbers(const std::string& option, const std::string& text,
                                               size_t n);
/// "1280x720": whole numbers from 1 to 65536.
[[nodiscard]] V2i parse_size(const std::string& option, const std::string& text);
/// "36x24": two numbers from least to most, millimetres.
[[nodiscard]] V2f parse_sensor(const std::string& option, const std::string& text, double least,
                               double most);
/// "x,y,w,h" in pixels of a frame; must lie inside it and hold a pixel.
[[nodiscard]] Rect parse_crop(const std::string& option, const std::string& text, V2i frame);
/// "x,y": two whole numbers.
[[nodiscard]] V2i parse_pixel(const std::string& option, const std::string& text);
/// "90", "90s", "1.5m", "2h": seconds above 0.
[[nodiscard]] double parse_duration_s(const std::string& option, const std::string& text);
/// "1%" or "0.01": a share above 0, 1 at most.
[[nodiscard]] double parse_share(const std::string& option, const std::string& text);
/// "0.01" or "1/100": seconds above 0.
[[nodiscard]] float parse_shutter_s(const std::string& option, const std::string& text);
/// "1.5", "1.5m" (metres above 0) or "infinity"; metres.
[[nodiscard]] float parse_focus_distance_m(const std::string& option, const std::string& text);
/// The same, or "auto", or "x,y" (a pixel of the frame).
[[nodiscard]] Focus parse_focus(const std::string& option, const std::string& text, V2i frame);
/// "380:730:10": edges of equal bins in nm, inside the wavelengths that paths carry.
[[nodiscard]] Bins parse_bins(const std::string& option, const std::string& text);
/// "albedo,normal": names of layers.
[[nodiscard]] std::vector<Aov> parse_aovs(const std::string& option, const std::string& text);

/// Checks of one number, for CLI11: what is wrong with a text, or nothing. Unlike CLI11's own they
/// refuse what is not finite.
using Check = std::function<std::string(const std::string&)>;
[[nodiscard]] Check number_between(double least, double most);
[[nodiscard]] Check whole_number_between(uint64_t least, uint64_t most);

}  // namespace petzval
