// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/mend/semantic.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

namespace petzval::io {
namespace {

constexpr std::array<std::string_view, 3> single = {"POSITION", "NORMAL", "TANGENT"};
constexpr std::array<std::string_view, 4> numbered = {"TEXCOORD", "COLOR", "JOINTS", "WEIGHTS"};

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
    const auto among = [](const auto& names, std::string_view base) {
        return std::find(names.begin(), names.end(), base) != names.end();
    };
    if (among(single, name)) return GltfSemantic{name, {}, false};
    const size_t bar = name.find('_');
    GltfSemantic semantic{name.substr(0, bar), {}, false};
    if (bar == std::string::npos || !among(numbered, semantic.base)) return std::nullopt;
    semantic.set = parse_set(std::string_view(name).substr(bar + 1));
    return semantic.set ? std::optional(semantic) : std::nullopt;
}

}  // namespace petzval::io
