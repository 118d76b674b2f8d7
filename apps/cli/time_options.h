// SPDX-License-Identifier: Apache-2.0
// Options of the moment that is shown of an animated scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/shutter.h"
#include "io/gltf/animation/choice.h"

namespace CLI {
class App;
}

namespace petzval {

/// Time options as given.
struct TimeOptions {
    std::optional<std::string> at;
    std::vector<std::string> animations;
    double fps = 24;
    bool loop = false;

    [[nodiscard]] bool plays() const { return at.has_value(); }
    /// What is played; nothing where no time is given. Throws CLI::ValidationError.
    [[nodiscard]] std::optional<AnimationChoice> animation() const;
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_time_options(CLI::App&, TimeOptions&);

/// Time in seconds from "1.25", "1.25s", "40ms" or "frame:30", of which `fps` make a second. Throws
/// CLI::ValidationError.
[[nodiscard]] double parse_time_s(const std::string& option, const std::string& text, double fps);

/// Shutter curve from "box" (or nothing), "trapezoid", or the name of a CSV file with the columns
/// time and open, whose times rise and which is stretched to the time that the shutter is open.
/// Throws InputError.
[[nodiscard]] ShutterCurve parse_shutter_curve(const std::string& option, const std::string& text);

}  // namespace petzval
