// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/base/named.h"

namespace petzval::io {
namespace {

using nlohmann::json;

// Whether a property ends as it begins: to a thousandth of how much it changes.
bool is_closed(const AnimatedProperty& property, double duration_s) {
    constexpr double kSame = 1e-3;
    const Keyframes& keys = property.keys;
    const std::vector<double> first = keys.at(0), last = keys.at(duration_s);
    double sign = 1;
    if (keys.rotation) {  // a quaternion and its negative are the same rotation
        double dot = 0;
        for (size_t k = 0; k < keys.width; ++k) dot += first[k] * last[k];
        if (dot < 0) sign = -1;
    }
    double apart = 0, most = 0;
    for (size_t k = 0; k < keys.width; ++k)
        apart = std::max(apart, std::fabs(first[k] - sign * last[k]));
    for (const double time_s : keys.times_s) {
        const std::vector<double> now = keys.at(time_s);
        for (size_t k = 0; k < keys.width; ++k) most = std::max(most, std::fabs(now[k] - first[k]));
    }
    return apart <= kSame * most;
}

}  // namespace

void GltfClip::find_whether_closed() {
    closed = std::all_of(properties.begin(), properties.end(),
                         [&](const auto& one) { return is_closed(one, duration_s); });
}

double GltfClip::local_s(double time_s, double frame_s, bool repeats) const {
    if (!(duration_s > 0)) return 0;
    if (!repeats) return std::clamp(time_s, 0., duration_s);
    // Times of keys are floats: the end in their digits is the beginning of the next turn.
    constexpr double kRounding = 0x1p-24, kMost = 1e-6;  // in turns
    const double turns = frame_s / duration_s;
    const double same = std::min(kRounding * (1 + std::fabs(turns)), kMost);
    const double turn_s = std::floor(turns + same) * duration_s;
    const double local = time_s - turn_s;
    if (closed) return local - std::floor(local / duration_s) * duration_s;
    return std::clamp(local, 0., duration_s);
}

std::string target_of(const json& channel) {
    const json& target = member(channel, "target");
    const std::string path = text_of(target, "path");
    if (path == "pointer")
        return text_of(member(member(target, "extensions"), "KHR_animation_pointer"), "pointer");
    const json& node = member(target, "node");
    return node.is_number_unsigned() ? fmt::format("/nodes/{}/{}", node.get<uint64_t>(), path)
                                     : std::string();
}

std::vector<size_t> played_animations(const json& root, const AnimationChoice& choice,
                                      const std::string& file) {
    const json& animations = member(root, "animations");
    std::vector<size_t> played;
    if (choice.names.empty()) {
        std::set<std::string> taken;
        for (size_t i = 0; i < animations.size(); ++i) {
            std::set<std::string> targets;
            for (const json& channel : member(animations[i], "channels"))
                targets.insert(target_of(channel));
            targets.erase("");
            const bool meets = std::any_of(targets.begin(), targets.end(),
                                           [&](const auto& one) { return taken.contains(one); });
            if (meets) continue;
            taken.merge(targets);
            played.push_back(i);
        }
        return played;
    }
    std::vector<std::string> names;
    for (const json& animation : animations) names.push_back(text_of(animation, "name"));
    for (const std::string& wanted : choice.names) {
        const auto found = find_named(wanted, names);
        if (!found)
            throw ArgumentError(
                file, "",
                no_such("animation", wanted, names, "the file has none, leave out ⟨animation⟩"));
        if (std::find(played.begin(), played.end(), *found) == played.end())
            played.push_back(*found);
    }
    return played;
}

}  // namespace petzval::io
