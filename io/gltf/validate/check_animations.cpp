// SPDX-License-Identifier: Apache-2.0
// Animations that are played are checked and decoded; a channel with a fault is left out. Of others
// only a broken one is told, or every fault where that is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/gltf/animation/pose.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// Greatest number of morph targets of a mesh, or of the mesh of a node; 0 for anything else.
size_t target_count(const json& root, const json& owner) {
    return morph_target_count(owner.contains("mesh") ? root["meshes"][owner["mesh"].get<size_t>()]
                                                     : owner);
}

/// What a fault is, with its place in the JSON but without the name of the file.
std::string text_of(const GltfCheck& check, const InputError& fault) {
    return std::string(fault.what()).substr(check.source.path.string().size() + 2);
}

/// Reads one animation, whose parts may be wrong.
class ClipReader {
  public:
    ClipReader(GltfCheck& check, GltfBudget& budget, const JsonCursor& animation)
        : check_(check),
          budget_(budget),
          animation_(animation),
          samplers_(animation.objects("samplers")) {}

    [[nodiscard]] GltfClip run() {
        animation_.require("samplers");
        animation_.require("channels");
        GltfClip clip;
        clip.name = animation_.text_or("name", "");
        for (const JsonCursor& channel : animation_.objects("channels")) try {
                read_channel(channel, clip);
            } catch (const InputError& fault) {
                if (over_budget_) throw;
                check_.source.warnings.push_back(
                    fmt::format("{}; {} is left out", text_of(check_, fault), channel.path()));
            }
        for (const AnimatedProperty& property : clip.properties)
            clip.duration_s = std::max(clip.duration_s, property.keys.times_s.back());
        clip.find_whether_closed();
        return clip;
    }

  private:
    void read_channel(const JsonCursor& channel, GltfClip& clip) {
        const size_t sampler =
            channel.required_index("sampler", samplers_.size(), "sampler of the animation");
        const JsonCursor target = channel.object("target");
        const bool has_node = target.index("node", check_.count("nodes"), "node").has_value();
        if (target.text("path") != "pointer" && !has_node) return;  // for extensions: glTF 2.0, 5.4
        const std::string pointer = target_of(channel.value());
        const GltfProperty* const property = animated_property(pointer);
        const size_t width = property ? width_of(*property, pointer) : 0;
        if (width == 0) {
            check_.warn(target, fmt::format("animates {}, which Petzval does not read or which is "
                                            "not there; it stays as the file stores it",
                                            pointer.empty() ? "nothing" : printable(pointer)));
            return;
        }
        const auto same = [&](const auto& one) { return one.pointer == pointer; };
        if (std::ranges::any_of(clip.properties, same)) {
            check_.warn(target, "animates what an earlier channel does; that one is taken");
            return;
        }
        clip.properties.push_back({pointer, read_keys(samplers_[sampler], property->kind, width)});
    }

    // Numbers of the property that a pointer leads to, weights counted; 0 where all that it leads
    // through is not there. Its last word may have a default.
    [[nodiscard]] size_t width_of(const GltfProperty& property, const std::string& pointer) {
        try {
            const json& root = check_.source.json;
            const json::json_pointer whole(pointer);
            json::json_pointer at = whole.parent_pointer();
            if (at.back() == "weights") write_out_weights(at);
            if (at.back() == "pbrMetallicRoughness") at.pop_back();
            if (!root.contains(at)) return 0;
            const json& owner = root[at];
            if (!owner.is_object() && !root.contains(whole)) return 0;
            // A node has a matrix or is animated: glTF 2.0, section 3.5.3.
            const std::string& name = whole.back();
            const bool moves = name == "translation" || name == "rotation" || name == "scale";
            if (moves && pointer.starts_with("/nodes/") && owner.contains("matrix")) return 0;
            if (property.kind == PropertyKind::Weights) return target_count(root, owner);
        } catch (const json::exception&) {  // no pointer, or an index beyond all numbers
            return 0;
        }
        return std::max<size_t>(property.width(), 1);
    }

    // Weights that have their default: 0, or at a node those of its mesh. One of them may move.
    void write_out_weights(const json::json_pointer& weights) {
        json& root = check_.source.json;
        if (!root.contains(weights.parent_pointer())) return;
        json& owner = root[weights.parent_pointer()];
        const size_t count = target_count(root, owner);
        if (count == 0 || owner.contains("weights")) return;
        json mesh = json::object();
        if (owner.contains("mesh")) mesh = root["meshes"][owner["mesh"].get<size_t>()];
        owner["weights"] = mesh.value("weights", json(std::vector<double>(count)));
    }

    [[nodiscard]] static Interpolation interpolation_of(const JsonCursor& sampler) {
        const std::string word = sampler.text_or("interpolation", "LINEAR");
        if (lower(word) == "linear") return Interpolation::Linear;
        if (lower(word) == "step") return Interpolation::Step;
        if (lower(word) == "cubicspline") return Interpolation::CubicSpline;
        sampler.fail("interpolation", "is \"{}\"; it must be LINEAR, STEP or CUBICSPLINE",
                     printable(word));
    }

    [[nodiscard]] Keyframes read_keys(const JsonCursor& sampler, PropertyKind kind, size_t width) {
        Keyframes keys;
        keys.interpolation = interpolation_of(sampler);
        if (kind == PropertyKind::Switch) keys.interpolation = Interpolation::Step;
        keys.rotation = kind == PropertyKind::Turn;
        const GltfAccessor& input = accessor(sampler, "input");
        if (input.components != 1) sampler.fail("input", "must be an accessor of SCALAR");
        keys.times_s = numbers_of(input, sampler);
        check_times(sampler, keys.times_s);
        const GltfAccessor& output = accessor(sampler, "output");
        keys.width = width;
        const auto components = static_cast<size_t>(output.components);
        if (components != 1 && components != keys.width)  // numbers of keys would be mixed
            sampler.fail("output", "is an accessor of {}, not of {} numbers",
                         printable(output.type), width);
        keys.values = numbers_of(output, sampler);
        const size_t parts = keys.interpolation == Interpolation::CubicSpline ? 3 : 1;
        const size_t needed = keys.times_s.size() * parts * keys.width;
        if (keys.values.size() < needed)
            sampler.fail("output", "holds {} numbers; {} keys need {}", keys.values.size(),
                         keys.times_s.size(), needed);
        if (keys.values.size() > needed)
            check_.warn(sampler, fmt::format("holds {} numbers in output, but {} keys need {}; "
                                             "those behind are not used",
                                             keys.values.size(), keys.times_s.size(), needed));
        const auto bad = std::ranges::find_if(keys.values, [](double x) {
            return !(std::fabs(x) <= std::numeric_limits<float>::max());
        });
        if (bad != keys.values.end())
            sampler.fail("output", "number {} is not finite",
                         std::distance(keys.values.begin(), bad));
        return keys;
    }

    // A file may play the same few bytes at thousands of nodes.
    [[nodiscard]] std::vector<double> numbers_of(const GltfAccessor& from,
                                                 const JsonCursor& sampler) {
        constexpr uint64_t kMostCounted = uint64_t(1) << 40;
        over_budget_ = true;  // where this throws
        budget_.ask(std::min(from.count, kMostCounted) * static_cast<uint64_t>(from.components) *
                        sizeof(double),
                    sampler);
        over_budget_ = false;
        return read_all<double>(from);
    }

    static void check_times(const JsonCursor& sampler, const std::vector<double>& times_s) {
        for (size_t i = 0; i < times_s.size(); ++i) {
            if (!std::isfinite(times_s[i]) || times_s[i] < 0)
                sampler.fail("input", "the time of key {} is not a number from 0", i);
            if (i > 0 && times_s[i] < times_s[i - 1])
                sampler.fail("input",
                             "key {} is before key {}: keys must come in the order of their times",
                             i, i - 1);
        }
    }

    [[nodiscard]] const GltfAccessor& accessor(const JsonCursor& sampler, const char* key) const {
        const size_t index = sampler.required_index(key, check_.accessors.size(), "accessor");
        const GltfAccessor& found = check_.accessors[index];
        if (found.components == 0) sampler.fail(key, "accessor {} has no type of numbers", index);
        return found;
    }

    GltfCheck& check_;
    GltfBudget& budget_;
    const JsonCursor& animation_;
    bool over_budget_ = false;  ///< more memory was asked for than a file may
    const std::vector<JsonCursor> samplers_;
};

/// Checks what an animation that is not played refers to.
void check_references(const GltfCheck& check, const JsonCursor& animation) {
    animation.require("samplers");
    animation.require("channels");
    for (const JsonCursor& sampler : animation.objects("samplers"))
        for (const char* key : {"input", "output"})
            (void)sampler.required_index(key, check.accessors.size(), "accessor");
    for (const JsonCursor& channel : animation.objects("channels")) {
        (void)channel.required_index("sampler", animation.length("samplers"), "sampler");
        const JsonCursor target = channel.object("target");
        (void)target.index("node", check.count("nodes"), "node");
        (void)target.text("path");
    }
}

}  // namespace

void check_animations(GltfCheck& check) {
    const auto animations = check.root.objects("animations");
    for (const size_t index : check.played)
        check.source.clips.push_back(ClipReader(check, check.budget, animations[index]).run());
    for (size_t i = 0; i < animations.size(); ++i) try {
            if (std::ranges::find(check.played, i) != check.played.end()) continue;
            GltfBudget budget = check.budget;  // what is read is not kept
            if (check.reads_all_animations)
                (void)ClipReader(check, budget, animations[i]).run();
            else
                check_references(check, animations[i]);
        } catch (const InputError& fault) {
            if (check.reads_all_animations)
                check.source.warnings.push_back(text_of(check, fault) + "; it cannot be played");
            else
                check.warn(animations[i], "is broken in places; petzval info names them");
        }
}

}  // namespace petzval::io
