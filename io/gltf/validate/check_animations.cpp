// SPDX-License-Identifier: Apache-2.0
// Animations are not played: only what they refer to is checked.
#include "io/base/error.h"
#include "io/gltf/validate/check.h"

namespace petzval {
namespace {

void check_channel(const JsonCursor& channel, size_t samplers, size_t nodes) {
    (void)channel.required_index("sampler", samplers, "sampler of the animation");
    const JsonCursor target = channel.object("target");
    (void)target.index("node", nodes, "node");
    (void)target.text("path");
}

void check_animation(const GltfCheck& check, const JsonCursor& animation) {
    animation.require("samplers");
    animation.require("channels");
    for (const JsonCursor& sampler : animation.objects("samplers")) {
        (void)sampler.required_index("input", check.accessors.size(), "accessor");
        (void)sampler.required_index("output", check.accessors.size(), "accessor");
        (void)sampler.text_or("interpolation", "LINEAR");
    }
    for (const JsonCursor& channel : animation.objects("channels"))
        check_channel(channel, animation.length("samplers"), check.count("nodes"));
}

}  // namespace

void check_animations(GltfCheck& check) {
    for (const JsonCursor& animation : check.root.objects("animations")) try {
            check_animation(check, animation);
        } catch (const InputError&) {
            check.warn(animation, "is broken; animations are not played");
        }
}

}  // namespace petzval
