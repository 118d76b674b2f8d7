// SPDX-License-Identifier: Apache-2.0
#include "io/base/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

#include "io/base/ascii.h"

namespace petzval::io {
namespace {

/// No known word is longer by much, and the distance takes time in proportion.
constexpr size_t kMostLetters = 64;

/// Rank of a known word, the less the nearer; nothing where it is not near.
std::optional<size_t> rank(const std::string& wanted, const std::string& word) {
    constexpr size_t shortest_part = 3;
    if (wanted == word) return 0;
    const size_t distance = edit_distance(wanted, word);
    if (distance <= std::max<size_t>(1, wanted.size() / 3) && distance < wanted.size())
        return distance;
    const size_t parted = wanted.size() < word.size() ? word.find(wanted) : wanted.find(word);
    if (std::min(wanted.size(), word.size()) < shortest_part || parted == std::string::npos)
        return std::nullopt;
    return kMostLetters + parted;  // after slips of the fingers, those at the beginning first
}

}  // namespace

size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (size_t i = 0; i < a.size(); ++i) {
        next[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            next[j + 1] = std::min({row[j] + (a[i] != b[j]), row[j + 1] + 1, next[j] + 1});
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
                next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
        }
        before.swap(row);
        row.swap(next);
    }
    return row.back();
}

std::vector<std::string> words_near(const std::string& text,
                                    const std::vector<std::string>& known) {
    constexpr size_t most = 3;
    const std::string wanted = lower(text.substr(0, kMostLetters));
    std::vector<std::tuple<size_t, std::string>> ranked;
    for (const std::string& word : known)
        if (const auto at = rank(wanted, lower(word))) ranked.emplace_back(*at, word);
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::string> near;
    for (size_t i = 0; i < std::min(most, ranked.size()); ++i)
        near.push_back(std::move(std::get<1>(ranked[i])));
    return near;
}

std::string did_you_mean(const std::string& text, const std::vector<std::string>& known) {
    const std::vector<std::string> near = words_near(text, known);
    return near.empty() ? "" : fmt::format("; did you mean {}?", fmt::join(near, " or "));
}

std::string did_you_mean_or(const std::string& there_are, const std::string& text,
                            const std::vector<std::string>& known) {
    std::string near = did_you_mean(text, known);
    return near.empty() ? fmt::format("; {} {}", there_are, fmt::join(known, ", ")) : near;
}

}  // namespace petzval::io
