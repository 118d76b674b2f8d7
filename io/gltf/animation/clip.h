// SPDX-License-Identifier: Apache-2.0
// Animations of a glTF file that are played: what they change, and when.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/gltf/animation/choice.h"
#include "io/gltf/animation/keyframes.h"

namespace petzval::io {

/// A property that changes.
struct AnimatedProperty {
    std::string pointer;  ///< where it stands in the JSON (RFC 6901)
    Keyframes keys;
};

/// An animation, decoded.
struct GltfClip {
    std::string name;
    double duration_s = 0;  ///< time of the last key of all
    bool closed = false;    ///< it ends as it begins
    std::vector<AnimatedProperty> properties;

    /// Sets `closed` from the keys.
    void find_whether_closed();
    /// Time in the clip that is shown at a time. Beyond its ends it stays as it is there. One that
    /// repeats begins anew at its end: `frame_s`, the middle of the exposure, decides how often it
    /// has begun. Beyond the ends of that turn a closed clip goes on, and another one stays.
    [[nodiscard]] double local_s(double time_s, double frame_s, bool repeats) const;
};

/// Numbers of the animations that are played: those of these names, else all but those that change
/// what an earlier one changes too. Throws ArgumentError where there is none of a name. root: a
/// file's JSON, in which animations may still be wrong.
[[nodiscard]] std::vector<size_t> played_animations(const nlohmann::json& root,
                                                    const AnimationChoice&,
                                                    const std::string& file);

/// Pointer to what a channel changes; empty where that is not told.
[[nodiscard]] std::string target_of(const nlohmann::json& channel);

}  // namespace petzval::io
