// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/pose.h"

#include <algorithm>

#include "io/gltf/schema/schema.h"

namespace petzval::io {
using nlohmann::json;

std::vector<std::string_view> words_of(const std::string& pointer) {
    std::vector<std::string_view> words;
    for (size_t at = 0; at < pointer.size() && pointer[at] == '/';) {
        const size_t end = std::min(pointer.find('/', at + 1), pointer.size());
        words.push_back(std::string_view(pointer).substr(at + 1, end - at - 1));
        at = end;
    }
    return words;
}

void pose(json& root, std::span<const GltfClip> clips, double time_s, double frame_s,
          bool repeats) {
    for (const GltfClip& clip : clips) {
        const double local_s = clip.local_s(time_s, frame_s, repeats);
        for (const AnimatedProperty& property : clip.properties) {
            const std::vector<double> values = property.keys.at(local_s);
            const PropertyKind kind = animated_property(property.pointer)->kind;
            json& target = root[json::json_pointer(property.pointer)];
            if (kind == PropertyKind::Switch)
                target = values[0] != 0;
            else if (kind == PropertyKind::Number)
                target = values[0];
            else
                target = values;
        }
    }
}

}  // namespace petzval::io
