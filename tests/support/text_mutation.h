// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>

namespace petzval::test {

/// A text with one to four changes: a byte becomes a digit, another of the text's bytes, one with a
/// bit flipped or anything, a piece is left out or repeated; now and then the end is cut off.
[[nodiscard]] inline std::string mutated(std::string text, std::mt19937& random) {
    const auto below = [&](size_t n) { return random() % n; };
    for (size_t i = 0, n = 1 + below(4); i < n && text.size() > 1; ++i) {
        const size_t at = below(text.size()), length = 1 + below(12);
        char& byte = text[at];
        switch (below(6)) {
            case 0:
                byte = static_cast<char>('0' + below(10));
                break;
            case 1:
                byte = text[below(text.size())];
                break;
            case 2:
                byte = static_cast<char>(byte ^ 1 << below(8));
                break;
            case 3:
                byte = static_cast<char>(random());
                break;
            case 4:
                text.erase(at, length);
                break;
            default:
                text.insert(at, text.substr(below(text.size()), length));
        }
    }
    if (below(16) == 0) text.resize(below(text.size() + 1));
    return text;
}

}  // namespace petzval::test
