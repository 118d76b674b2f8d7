// SPDX-License-Identifier: Apache-2.0
// KHR_meshopt_compression and EXT_meshopt_compression: bufferViews whose data are compressed.
#include <algorithm>
#include <array>

#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/gltf/compression/meshopt.h"
#include "io/gltf/schema/extensions.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

using nlohmann::json;
using Bytes = std::vector<uint8_t>;

/// The number of a word in a list; a word that is not there is refused.
template <size_t N>
size_t word(const JsonCursor& owner, const char* key, const std::string& text,
            const std::array<std::string_view, N>& words) {
    const auto at = std::find(words.begin(), words.end(), text);
    if (at == words.end()) owner.fail(key, "is \"" + printable(text) + "\", which is unknown");
    return size_t(at - words.begin());
}

MeshoptLayout layout_of(const JsonCursor& meshopt) {
    constexpr std::array<std::string_view, 3> modes = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    constexpr std::array<std::string_view, 5> filters = {"NONE", "OCTAHEDRAL", "QUATERNION",
                                                         "EXPONENTIAL", "COLOR"};
    MeshoptLayout layout;
    layout.mode = static_cast<MeshoptMode>(word(meshopt, "mode", meshopt.text("mode"), modes));
    layout.filter = static_cast<MeshoptFilter>(
        word(meshopt, "filter", meshopt.text_or("filter", "NONE"), filters));
    layout.count = meshopt.integer("count");
    layout.stride = meshopt.integer("byteStride");
    return layout;
}

std::span<const uint8_t> stream_of(const GltfCheck& check, const JsonCursor& meshopt) {
    const auto& buffers = check.source.buffers;
    const Bytes& buffer = buffers[meshopt.required_index("buffer", buffers.size(), "buffer")];
    const uint64_t offset = meshopt.integer_or("byteOffset", 0);
    const uint64_t length = meshopt.integer("byteLength");
    if (offset > buffer.size() || length > buffer.size() - offset)
        meshopt.fail("its data do not lie in its buffer; the file is cut short");
    return {buffer.data() + offset, length};
}

/// What a bufferView is decoded to; nothing where its data are there plainly.
std::optional<Bytes> decode(GltfCheck& check, const JsonCursor& view) {
    const auto meshopt = meshopt_extension(view);
    if (!meshopt) return std::nullopt;
    const auto& buffers = check.source.buffers;
    if (!buffers[view.required_index("buffer", buffers.size(), "buffer")].empty())
        return std::nullopt;
    const MeshoptLayout layout = layout_of(*meshopt);
    const auto stream = stream_of(check, *meshopt);
    if (const std::string fault = meshopt_fault(layout, stream); !fault.empty())
        meshopt->fail(fault);
    check.budget.ask_decoded(layout.count * layout.stride, *meshopt);
    auto bytes = decode_meshopt(layout, stream);
    if (!bytes) meshopt->fail("its data cannot be decoded; the file is damaged");
    return bytes;
}

}  // namespace

void decode_buffer_views(GltfCheck& check) {
    const auto views = check.root.objects("bufferViews");
    std::vector<Bytes> decoded;
    for (size_t i = 0; i < views.size(); ++i) {
        if (!check.use.views[i]) continue;
        auto bytes = decode(check, views[i]);
        if (!bytes) continue;
        json& view = check.source.json["bufferViews"][i];
        view["buffer"] = check.source.buffers.size() + decoded.size();
        view["byteOffset"] = 0;
        decoded.push_back(std::move(*bytes));
    }
    for (Bytes& bytes : decoded) {
        check.source.json["buffers"].push_back({{"byteLength", bytes.size()}});
        check.source.buffers.push_back(std::move(bytes));
    }
}

}  // namespace petzval::io
