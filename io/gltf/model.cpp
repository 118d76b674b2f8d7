// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/model.h"

#include <tiny_gltf.h>

#include "io/base/error.h"
#include "io/base/json_cursor.h"
#include "io/gltf/validate/accessor.h"

namespace petzval {
namespace {

using nlohmann::json;

// Replaces buffers by one byte each: tinygltf refuses buffers without a uri and reads files by
// itself.
void replace_bytes(json& patched, size_t buffer_count) {
    const json stand_in = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
    patched["buffers"] = json::array();
    for (size_t i = 0; i < buffer_count; ++i) patched["buffers"].push_back(stand_in);
}

// Replaces bufferViews, as tinygltf refuses strides that do no harm; take_views() brings back their
// numbers. Gives accessors without a bufferView one that is told from the others by being the last:
// tinygltf refuses such indices (all zero, by the specification). Replaces unknown types, which it
// also refuses; nothing drawn can have them.
void replace_accessors(json& patched) {
    const size_t no_view = patched.value("bufferViews", json::array()).size();
    json& views = patched["bufferViews"] = json::array();
    while (views.size() <= no_view) views.push_back({{"buffer", 0}, {"byteLength", 1}});
    if (!patched.contains("accessors")) return;
    for (json& accessor : patched["accessors"]) {
        if (!accessor.contains("bufferView")) accessor["bufferView"] = no_view;
        const bool known = component_size(accessor["componentType"].get<int>()) > 0 &&
                           component_count(accessor["type"].get<std::string>()) > 0;
        if (!known) accessor.update({{"componentType", 5121}, {"type", "SCALAR"}});
    }
}

// What tinygltf reads. It parses texts only, and whole: nodes and images in them would take a
// kilobyte each, and reads at unchecked places; so it is given a text without them.
std::string text_for(const GltfSource& source) {
    json patched = json::object();
    for (const char* key : {"asset", "accessors", "bufferViews", "meshes", "skins", "textures",
                            "samplers", "scenes", "scene", "extensions"})
        if (const auto at = source.json.find(key); at != source.json.end()) patched[key] = *at;
    replace_bytes(patched, source.buffers.size() + 1);
    replace_accessors(patched);
    return patched.dump();
}

void take_views(const GltfSource& source, tinygltf::Model& model) {
    const std::string file = source.path.string();
    const auto views = JsonCursor(source.json, file).objects("bufferViews");
    for (size_t i = 0; i < views.size(); ++i) {
        tinygltf::BufferView& view = model.bufferViews[i];
        view.buffer = static_cast<int>(views[i].integer("buffer"));
        view.byteOffset = views[i].integer_or("byteOffset", 0);
        view.byteLength = views[i].integer("byteLength");
        view.byteStride = views[i].integer_or("byteStride", 0);
    }
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
        const std::string text = text_for(source);
        tinygltf::TinyGLTF parser;
        parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(),
                                            static_cast<unsigned>(text.size()), "");
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!parsed) throw InputError(source.path.string(), "", "cannot be parsed: " + one_line(error));

    model.bufferViews.pop_back();
    take_views(source, model);
    for (tinygltf::Accessor& accessor : model.accessors)
        if (accessor.bufferView == static_cast<int>(model.bufferViews.size()))
            accessor.bufferView = -1;
    return model;
}

}  // namespace petzval
