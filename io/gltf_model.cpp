// SPDX-License-Identifier: Apache-2.0
#include "io/gltf_model.h"

#include <tiny_gltf.h>

#include "io/error.h"

namespace petzval {
namespace {

using nlohmann::json;

// tinygltf refuses buffers without a uri, reads files by itself, and indexes buffers by an image's
// bufferView unchecked: it is given buffers of one byte and no images. It also refuses indices
// without a bufferView (all zero, by the specification), so those get a stand-in at the end.
json without_bytes(const GltfSource& source) {
    json patched = source.json;
    for (const char* unused : {"images", "animations", "extras"}) patched.erase(unused);

    const json stand_in = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
    patched["buffers"] = json::array();
    for (size_t i = 0; i < source.buffers.size() + 1; ++i) patched["buffers"].push_back(stand_in);

    json& views = patched["bufferViews"];
    views.push_back({{"buffer", source.buffers.size()}, {"byteLength", 1}});
    const size_t no_view = views.size() - 1;
    if (patched.contains("accessors"))
        for (json& accessor : patched["accessors"])
            if (!accessor.contains("bufferView")) accessor["bufferView"] = no_view;
    return patched;
}

std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
    for (char& c : text)
        if (c == '\n') c = ' ';
    return text;
}

}  // namespace

tinygltf::Model parse_model(const GltfSource& source) {
    tinygltf::Model model;
    std::string error, warning;
    bool parsed = false;
    try {
        const std::string text = without_bytes(source).dump();
        tinygltf::TinyGLTF parser;
        parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(),
                                            static_cast<unsigned>(text.size()), "");
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!parsed)
        throw InputError(source.path.string(), "", "cannot be parsed: " + one_line(error));

    model.bufferViews.pop_back();
    for (tinygltf::Accessor& accessor : model.accessors)
        if (accessor.bufferView == static_cast<int>(model.bufferViews.size()))
            accessor.bufferView = -1;
    return model;
}

}  // namespace petzval
