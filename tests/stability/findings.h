// SPDX-License-Identifier: Apache-2.0
// The numbers of a finding of the map of failures: against theory where there is one, else
// against those that were found first, with a tolerance that has a reason. Processors and compilers
// may round otherwise, in the C library, in Embree, and where products and sums are contracted.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "core/traversal/bvh.h"
#include "tests/stability/sweeps.h"

namespace petzval::stability {

/// How far a number may be off: in proportion, and besides.
struct Tolerance {
    double relative = 0, absolute = 0;
    double factor = 1;  ///< in place of both: so many times as much, or as little
};
/// Cells have three digits, and places of failure are bisected to 1e-3.
inline constexpr Tolerance kAsPrinted{.relative = 0.01};
/// The greatest of some hundred roundings: with others it is another one, of the same size.
/// Products that are contracted with sums move it by 3.2 times at most.
inline constexpr Tolerance kSizeOfRounding{.factor = 5};

inline bool near(double found, double expected, const Tolerance& t) {
    if (found == expected) return true;
    if (!std::isfinite(found) || !std::isfinite(expected)) return false;
    if (t.factor != 1)
        return found * expected > 0 && std::fabs(std::log(found / expected)) <= std::log(t.factor);
    return std::fabs(found - expected) <= t.relative * std::fabs(expected) + t.absolute;
}

/// A cell, of which a percentage is its number; nothing for what is not a number.
inline std::optional<double> number_in(const std::string& cell) {
    std::istringstream text(cell);
    std::string first, unit, rest;
    text >> first >> unit >> rest;
    if (!rest.empty() || (!unit.empty() && unit != "%")) return std::nullopt;
    if (first == "infinity") return HUGE_VAL;
    size_t used = 0;
    try {
        const double a = std::stod(first, &used);
        if (used == first.size()) return a;
    } catch (const std::logic_error&) {
    }
    return std::nullopt;
}

inline std::vector<std::string> split(const std::string& words) {
    std::istringstream text(words);
    return {std::istream_iterator<std::string>(text), {}};
}

/// Expected: a number; "none", as it stands; "-" for an empty cell; "*" for anything.
inline void expect_cell(const std::string& found, const std::string& expected, const Tolerance& t,
                        const std::string& where) {
    if (expected == "*") return;
    const auto wanted = number_in(expected), is = number_in(found);
    if (wanted && is)
        EXPECT_TRUE(near(*is, *wanted, t)) << where << ": " << found << ", not " << expected;
    else
        EXPECT_EQ(found, expected == "-" ? "" : expected) << where;
}

/// Sweeps run as stability_findings() runs them.
class Findings : public ::testing::Test {
  protected:
    explicit Findings() { flush_denormals(); }

    void take(Finding finding) { f = std::move(finding); }
    [[nodiscard]] size_t rows() const { return f.table.rows.size(); }
    [[nodiscard]] const std::string& cell(size_t row, const std::string& column) const {
        const auto& names = f.table.columns;
        const auto at = std::find(names.begin(), names.end(), column);
        if (at == names.end()) throw std::out_of_range("no column " + column);
        return f.table.rows.at(row).at(size_t(at - names.begin()));
    }
    [[nodiscard]] double value(size_t row, const std::string& column) const {
        return number_in(cell(row, column)).value_or(NAN);
    }
    void expect_column(const std::string& column, const std::string& expected,
                       const Tolerance& t = kAsPrinted) const {
        const auto cells = split(expected);
        ASSERT_EQ(rows(), cells.size()) << column;
        for (size_t i = 0; i < cells.size(); ++i)
            expect_cell(cell(i, column), cells[i], t, column + ", row " + std::to_string(i + 1));
    }
    /// The numbers of the sentence, in its order; those of names are none.
    void expect_where(const std::string& expected, const Tolerance& t = kAsPrinted) const {
        const std::regex number("(^|[ (/:])([-+]?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?)(?=$|[ ,;:.)])");
        std::vector<std::string> found;
        for (std::sregex_iterator i(f.where.begin(), f.where.end(), number), end; i != end; ++i)
            found.push_back((*i)[2]);
        const auto wanted = split(expected);
        ASSERT_EQ(found.size(), wanted.size()) << f.where;
        for (size_t i = 0; i < found.size(); ++i) expect_cell(found[i], wanted[i], t, f.where);
    }

    Finding f;
};

}  // namespace petzval::stability
