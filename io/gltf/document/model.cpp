// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/document/model.h"

#include <tiny_gltf.h>

#include "io/base/error.h"

namespace petzval::io {
namespace {

using nlohmann::json;

// What tinygltf reads well. It parses texts only, and whole; nodes would take a kilobyte each in
// it. It wants accessors where something names them, with bufferViews and buffers: all are the
// same one. What is in them is known (GltfSource::accessors), and it would refuse some of that.
std::string text_for(const GltfSource& source) {
    const json buffer = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
    const json view = {{"buffer", 0}, {"byteLength", 1}};
    const json one = {{"bufferView", 0}, {"componentType", 5121}, {"type", "SCALAR"}, {"count", 1}};
    json text = {{"buffers", json::array_t(1, buffer)},
                 {"bufferViews", json::array_t(1, view)},
                 {"accessors", json::array_t(source.accessors.size(), one)}};
    for (const char* key :
         {"asset", "meshes", "skins", "textures", "samplers", "scenes", "scene", "extensions"})
        if (const auto at = source.json.find(key); at != source.json.end()) text[key] = *at;
    return text.dump();
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

    return model;
}

}  // namespace petzval::io
