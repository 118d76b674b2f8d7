// SPDX-License-Identifier: Apache-2.0
#include "io/base/uri.h"

#include "io/base/ascii.h"

namespace petzval {
namespace {

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

std::optional<std::string> decode_percent(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        if (i + 2 >= text.size()) return std::nullopt;
        const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        out += char(high * 16 + low);
        i += 2;
    }
    return out;
}

}  // namespace

std::optional<std::vector<uint8_t>> decode_base64(std::string_view text) {
    for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<uint8_t> out;
    out.reserve(text.size() / 4 * 3 + 2);
    uint32_t word = 0;
    int bits = 0;
    for (char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) return std::nullopt;
        word = word << 6 | uint32_t(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        out.push_back(uint8_t(word >> bits));
    }
    return out;
}

bool is_data_uri(std::string_view uri) {
    return lower(std::string(uri.substr(0, 5))) == "data:";
}

std::optional<DataUri> parse_data_uri(std::string_view uri) {
    const size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string_view::npos) return std::nullopt;
    const std::string head = lower(std::string(uri.substr(5, comma - 5)));
    if (!head.ends_with(";base64")) return std::nullopt;
    auto bytes = decode_base64(uri.substr(comma + 1));
    if (!bytes) return std::nullopt;
    return DataUri{head.substr(0, head.find(';')), std::move(*bytes)};
}

std::string encode_base64(std::span<const uint8_t> bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t n = std::min<size_t>(3, bytes.size() - i);
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::optional<std::string> relative_path(std::string_view uri) {
    const size_t colon = uri.find(':');
    const bool has_scheme = colon != std::string_view::npos && colon < uri.find('/');
    if (has_scheme || uri.starts_with('/')) return std::nullopt;
    const auto path = decode_percent(uri);
    if (!path || path->empty() || path->starts_with('/')) return std::nullopt;
    if (path->find('\0') != std::string::npos) return std::nullopt;
    return path;
}

}  // namespace petzval
