// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/attributes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

namespace petzval {
namespace {

/// Formats that an attribute may have; words are separated by blanks.
struct Formats {
    std::string_view base;
    bool numbered;
    std::string_view types, components, quantized;
};

constexpr std::array<Formats, 7> formats = {
    {{"POSITION", false, "VEC3", "float", "int8 int8n uint8 uint8n int16 int16n uint16 uint16n"},
     {"NORMAL", false, "VEC3", "float", "int8n int16n"},
     {"TANGENT", false, "VEC4", "float", "int8n int16n"},
     {"TEXCOORD", true, "VEC2", "float uint8n uint16n", "int8 int8n uint8 int16 int16n uint16"},
     {"COLOR", true, "VEC3 VEC4", "float uint8n uint16n", ""},
     {"JOINTS", true, "VEC4", "uint8 uint16", ""},
     {"WEIGHTS", true, "VEC4", "float uint8n uint16n", ""}}};

const Formats* find_formats(std::string_view base) {
    const auto at = std::find_if(formats.begin(), formats.end(),
                                 [base](const Formats& row) { return row.base == base; });
    return at == formats.end() ? nullptr : &*at;
}

bool lists(std::string_view words, std::string_view wanted) {
    while (!words.empty()) {
        const size_t blank = words.find(' ');
        if (words.substr(0, blank) == wanted) return true;
        words.remove_prefix(blank == std::string_view::npos ? words.size() : blank + 1);
    }
    return false;
}

/// Set number: decimal, without leading zeros.
std::optional<uint64_t> parse_set(std::string_view digits) {
    if (digits.empty() || (digits.size() > 1 && digits[0] == '0')) return std::nullopt;
    uint64_t set = 0;
    const char* end = digits.data() + digits.size();
    const auto parsed = std::from_chars(digits.data(), end, set);
    if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
    return set;
}

}  // namespace

std::optional<GltfSemantic> parse_gltf_semantic(const std::string& name) {
    if (name.starts_with('_')) return GltfSemantic{name, {}, true};
    const size_t bar = name.find('_');
    GltfSemantic semantic{name.substr(0, bar), {}, false};
    const Formats* row = find_formats(semantic.base);
    if (!row || row->numbered != (bar != std::string::npos)) return std::nullopt;
    if (!row->numbered) return semantic;
    semantic.set = parse_set(std::string_view(name).substr(bar + 1));
    return semantic.set ? std::optional(semantic) : std::nullopt;
}

std::string component_name(const GltfAccessor& accessor) {
    const auto name = [&accessor] {
        switch (accessor.component_type) {
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
    return std::string(name()) + (accessor.normalized ? "n" : "");
}

bool is_allowed_format(const GltfSemantic& semantic, const GltfAccessor& accessor, bool quantized,
                       bool is_target) {
    if (semantic.custom) return accessor.component_type != 5125;
    const Formats& row = *find_formats(semantic.base);
    // The sign of a tangent's fourth component cannot be morphed.
    const bool short_tangent = is_target && row.base == "TANGENT";
    const bool type_fits =
        short_tangent ? accessor.type == "VEC3" : lists(row.types, accessor.type);
    const std::string component = component_name(accessor);
    return type_fits &&
           (lists(row.components, component) || (quantized && lists(row.quantized, component)));
}

}  // namespace petzval
