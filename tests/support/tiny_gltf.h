// SPDX-License-Identifier: Apache-2.0
// Tiny glTF files for tests: fill the JSON, add data to the one buffer, save as .gltf or .glb.
//
//     TinyGltf file;
//     const int mesh = file.add_triangle();
//     file.add_root({{"mesh", mesh}});
//     file.json["nodes"][0]["scale"] = {2, 2, 2};  // whatever a test needs, or breaks
//     const auto path = file.save_glb(folder.path / "triangle.glb");
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace petzval {

/// A folder of its own under the system's temporary one, removed with all its content at the end.
struct TempFolder {
    std::filesystem::path path;

    TempFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "petzval-XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
        path = name;
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;
    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
};

/// Writes bytes to a file and returns its path.
inline std::filesystem::path save_bytes(const std::filesystem::path& path,
                                        std::span<const uint8_t> bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return path;
}

/// Base64 with padding (RFC 4648, section 4).
inline std::string base64(std::span<const uint8_t> bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t n = std::min<size_t>(3, bytes.size() - i);
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? bytes[i + k] : 0);
        for (size_t k = 0; k < 4; ++k) text += k <= n ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// The glTF componentType of a C++ type.
template <class T>
constexpr int component_type() {
    if constexpr (std::is_same_v<T, int8_t>) return 5120;
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, int16_t>) return 5122;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    if constexpr (std::is_same_v<T, float>) return 5126;
}

/// A glTF file with one buffer and, once it has a root node, one scene.
struct TinyGltf {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
    std::vector<uint8_t> bin;  ///< becomes buffer 0 when saved, if not empty

    /// Appends value to the root array `kind` ("materials", "nodes" ...); returns its index.
    int add(const char* kind, nlohmann::json value) {
        json[kind].push_back(std::move(value));
        return int(json[kind].size()) - 1;
    }

    /// Appends data to the buffer, aligned to 4 bytes, as a bufferView; more: e.g. byteStride.
    int add_view(std::span<const uint8_t> data, nlohmann::json more = nlohmann::json::object()) {
        bin.resize((bin.size() + 3) / 4 * 4);
        more["buffer"] = 0;
        more["byteOffset"] = bin.size();
        more["byteLength"] = data.size();
        bin.insert(bin.end(), data.begin(), data.end());
        return add("bufferViews", std::move(more));
    }

    template <class T>
    int add_view_of(const std::vector<T>& values, nlohmann::json more = nlohmann::json::object()) {
        const auto* first = reinterpret_cast<const uint8_t*>(values.data());
        return add_view({first, values.size() * sizeof(T)}, std::move(more));
    }

    /// A bufferView and its accessor. type: "SCALAR", "VEC2" ...; values: tightly packed
    /// components; more: e.g. {{"normalized", true}}.
    template <class T>
    int add_accessor(const std::string& type, const std::vector<T>& values,
                     nlohmann::json more = nlohmann::json::object()) {
        const size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : size_t(type.back() - '0');
        more["bufferView"] = add_view_of(values);
        more["componentType"] = component_type<T>();
        more["type"] = type;
        more["count"] = values.size() / width;
        return add("accessors", std::move(more));
    }

    /// A VEC3 float accessor with the min and max that POSITION must have.
    int add_positions(const std::vector<float>& xyz) {
        std::vector<float> lo(xyz.begin(), xyz.begin() + 3), hi = lo;
        for (size_t i = 0; i < xyz.size(); ++i) {
            lo[i % 3] = std::min(lo[i % 3], xyz[i]);
            hi[i % 3] = std::max(hi[i % 3], xyz[i]);
        }
        return add_accessor("VEC3", xyz, {{"min", lo}, {"max", hi}});
    }

    /// A mesh of one primitive.
    int add_mesh(nlohmann::json primitive) {
        return add("meshes", {{"primitives", nlohmann::json::array({std::move(primitive)})}});
    }

    /// The triangle (0,0,0) (1,0,0) (0,1,0), indexed; more: e.g. {{"material", 0}}.
    int add_triangle(nlohmann::json more = nlohmann::json::object()) {
        more["attributes"]["POSITION"] = add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
        more["indices"] = add_accessor<uint16_t>("SCALAR", {0, 1, 2});
        return add_mesh(std::move(more));
    }

    /// An embedded image: encoded bytes in a bufferView.
    int add_image(std::span<const uint8_t> encoded, const char* mime_type = "image/png") {
        return add("images", {{"bufferView", add_view(encoded)}, {"mimeType", mime_type}});
    }

    /// A node that stands at the root of scene 0, which is made when needed.
    int add_root(nlohmann::json node) {
        const int index = add("nodes", std::move(node));
        json["scene"] = 0;
        json["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    /// The file as text with the buffer in a data URI. A "buffers" that the test has set itself
    /// stays.
    std::string text() const {
        nlohmann::json out = json;
        if (!bin.empty() && !out.contains("buffers"))
            out["buffers"] = {{{"byteLength", bin.size()},
                               {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
        return out.dump();
    }

    /// Saves text().
    std::filesystem::path save_gltf(const std::filesystem::path& path) const {
        const std::string out = text();
        return save_bytes(path, {reinterpret_cast<const uint8_t*>(out.data()), out.size()});
    }

    /// Saves as a binary container, the buffer in its BIN chunk.
    std::filesystem::path save_glb(const std::filesystem::path& path) const {
        nlohmann::json out = json;
        if (!bin.empty() && !out.contains("buffers"))
            out["buffers"] = {{{"byteLength", bin.size()}}};
        std::string text = out.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::vector<uint8_t> padded = bin;
        padded.resize((bin.size() + 3) / 4 * 4);

        const size_t bin_chunk = padded.empty() ? 0 : 8 + padded.size();
        std::vector<uint8_t> file;
        put_words(file, {0x46546C67, 2, uint32_t(12 + 8 + text.size() + bin_chunk)});
        put_words(file, {uint32_t(text.size()), 0x4E4F534A});
        file.insert(file.end(), text.begin(), text.end());
        if (bin_chunk) put_words(file, {uint32_t(padded.size()), 0x004E4942});
        file.insert(file.end(), padded.begin(), padded.end());
        return save_bytes(path, file);
    }

    /// Appends 32-bit little-endian words: the headers of a .glb.
    static void put_words(std::vector<uint8_t>& to, std::initializer_list<uint32_t> words) {
        for (uint32_t word : words)
            for (int k = 0; k < 4; ++k) to.push_back(uint8_t(word >> 8 * k));
    }
};

}  // namespace petzval
