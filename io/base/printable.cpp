// SPDX-License-Identifier: Apache-2.0
#include "io/base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace petzval::io {
namespace {

struct CodeRange {
    uint32_t first, last;
};

// Unicode 15.1: controls (Cc), separators of lines and paragraphs (Zl, Zp), interlinear annotation,
// and Default_Ignorable_Code_Point (DerivedCoreProperties.txt) without variation selectors: those
// change how the character before them looks, in emoji mostly.
constexpr std::array<CodeRange, 19> kHidden{{{0x00, 0x1F},
                                             {0x7F, 0x9F},
                                             {0xAD, 0xAD},
                                             {0x34F, 0x34F},
                                             {0x61C, 0x61C},
                                             {0x115F, 0x1160},
                                             {0x17B4, 0x17B5},
                                             {0x180E, 0x180E},
                                             {0x200B, 0x200F},
                                             {0x2028, 0x202E},
                                             {0x2060, 0x206F},
                                             {0x3164, 0x3164},
                                             {0xFEFF, 0xFEFF},
                                             {0xFFA0, 0xFFA0},
                                             {0xFFF0, 0xFFFB},
                                             {0x1BCA0, 0x1BCA3},
                                             {0x1D173, 0x1D17A},
                                             {0xE0000, 0xE00FF},
                                             {0xE01F0, 0xE0FFF}}};

bool is_hidden(uint32_t code) {
    return std::any_of(kHidden.begin(), kHidden.end(), [code](const CodeRange& range) {
        return code >= range.first && code <= range.last;
    });
}

// Text made visible, up to so many bytes; whole characters and escapes only.
std::string visible_up_to(size_t most_bytes, std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const Character character = first_character(text);
        const size_t taken = std::max<size_t>(character.bytes, 1);
        std::string shown(text.substr(0, taken));
        if (character.bytes == 0)
            shown = fmt::format("\\x{:02x}", static_cast<uint8_t>(text.front()));
        else if (is_hidden(character.code))
            shown = character.code > 0xFFFF ? fmt::format("\\U{:08x}", character.code)
                                            : fmt::format("\\u{:04x}", character.code);
        if (shown.size() > most_bytes - out.size()) return out + "...";
        out += shown;
        text.remove_prefix(taken);
    }
    return out;
}

}  // namespace

Character first_character(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
    const uint8_t lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {0, 0};
    uint32_t code = lead & (0xFFu >> (bytes + 1));
    for (size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {0, 0};
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    constexpr std::array<uint32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return {code, code < least[bytes] || code > 0x10FFFF || surrogate ? 0 : bytes};
}

std::string visible(std::string_view text) {
    return visible_up_to(std::string::npos, text);
}

std::string printable(std::string_view text) {
    return visible_up_to(80, text);
}

std::string for_shell(const std::string& word) {
    const auto is_plain = [](unsigned char c) {
        return c >= 0x80 || std::isalnum(c) ||
               std::string_view("%+,-./:=@_").find(char(c)) != std::string_view::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

}  // namespace petzval::io
