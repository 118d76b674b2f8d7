// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/mend/attributes.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace petzval::io {
namespace {

/// Formats that an attribute may have; words are separated by blanks.
struct Formats {
    std::string_view base;
    std::string_view types, components, quantized;
};

constexpr std::array<Formats, 7> formats = {
    {{"POSITION", "VEC3", "float", "int8 int8n uint8 uint8n int16 int16n uint16 uint16n"},
     {"NORMAL", "VEC3", "float", "int8n int16n"},
     {"TANGENT", "VEC4", "float", "int8n int16n"},
     {"TEXCOORD", "VEC2", "float uint8n uint16n", "int8 int8n uint8 int16 int16n uint16"},
     {"COLOR", "VEC3 VEC4", "float uint8n uint16n", ""},
     {"JOINTS", "VEC4", "uint8 uint16", ""},
     {"WEIGHTS", "VEC4", "float uint8n uint16n", ""}}};

const Formats& formats_of(std::string_view base) {
    return *std::find_if(formats.begin(), formats.end(),
                         [base](const Formats& row) { return row.base == base; });
}

bool lists(std::string_view words, std::string_view wanted) {
    while (!words.empty()) {
        const size_t blank = words.find(' ');
        if (words.substr(0, blank) == wanted) return true;
        words.remove_prefix(blank == std::string_view::npos ? words.size() : blank + 1);
    }
    return false;
}

}  // namespace

std::string component_name(const GltfFormat& format) {
    const auto name = [&format] {
        switch (format.component_type) {
            case 5120:
                return "int8";
            case 5121:
                return "uint8";
            case 5122:
                return "int16";
            case 5123:
                return "uint16";
            case 5125:
                return "uint32";
            case 5126:
                return "float";
            default:
                return "unknown";
        }
    };
    return std::string(name()) + (format.normalized ? "n" : "");
}

bool is_allowed_format(const GltfSemantic& semantic, const GltfFormat& format, bool quantized,
                       bool is_target) {
    if (semantic.custom) return format.component_type != 5125;
    const Formats& row = formats_of(semantic.base);
    // The sign of a tangent's fourth component cannot be morphed.
    const bool short_tangent = is_target && row.base == "TANGENT";
    const bool type_fits = short_tangent ? format.type == "VEC3" : lists(row.types, format.type);
    const std::string component = component_name(format);
    return type_fits &&
           (lists(row.components, component) || (quantized && lists(row.quantized, component)));
}

}  // namespace petzval::io
