// SPDX-License-Identifier: Apache-2.0
#include "io/base/uri.h"

#include <algorithm>

#include "io/base/ascii.h"

namespace petzval::io {
namespace {

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

// An escape that is broken is taken as it stands: exporters forget to write % as %25.
std::string decode_percent(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        const bool follows = text[i] == '%' && i + 2 < text.size();
        const int high = follows ? hex_digit(text[i + 1]) : -1;
        const int low = follows ? hex_digit(text[i + 2]) : -1;
        const bool escape = high >= 0 && low >= 0;
        out += escape ? char(high * 16 + low) : text[i];
        if (escape) i += 2;
    }
    return out;
}

}  // namespace

std::optional<std::vector<uint8_t>> decode_base64(std::string_view text) {
    std::vector<uint8_t> out;
    out.reserve(text.size() / 4 * 3 + 2);
    uint32_t word = 0;
    size_t digits = 0, padding = 0;
    int bits = 0;
    for (char c : text) {
        if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
        padding += c == '=';
        if (c == '=') continue;
        const int digit = base64_digit(c);
        if (digit < 0 || padding > 0) return std::nullopt;
        ++digits;
        word = word << 6 | uint32_t(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        out.push_back(uint8_t(word >> bits));
    }
    if (padding > 2 || digits % 4 == 1) return std::nullopt;
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
    std::string path = decode_percent(uri);
    std::replace(path.begin(), path.end(), '\\', '/');  // as Windows writes
    if (path.empty() || path.starts_with('/')) return std::nullopt;
    if (path.find('\0') != std::string::npos) return std::nullopt;
    return path;
}

}  // namespace petzval::io
