// SPDX-License-Identifier: Apache-2.0
#include "io/glass/agf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/spectrum/spectrum_table.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/file/text_lines.h"

namespace petzval::io {
namespace {

// Dispersion formulas by Zemax's number, from 1, and how many coefficients each has; 0: not
// supported. Descriptions of Sellmeier 2 differ (w^2 or 1 in its last numerator), and no glass in
// use has it.
struct Formula {
    const char* name;
    size_t coefficients;
};
constexpr std::array<Formula, 13> kFormulas{{{"Schott", 6},
                                             {"Sellmeier 1", 6},
                                             {"Herzberger", 0},
                                             {"Sellmeier 2", 0},
                                             {"Conrady", 3},
                                             {"Sellmeier 3", 8},
                                             {"Handbook of Optics 1", 0},
                                             {"Handbook of Optics 2", 0},
                                             {"Sellmeier 4", 5},
                                             {"Extended 1", 8},
                                             {"Sellmeier 5", 10},
                                             {"Extended 2", 8},
                                             {"Extended 3", 9}}};

template <class Series>
Series series(const std::vector<double>& a, std::initializer_list<double> powers) {
    Series out;
    size_t i = 0;
    for (const double power : powers)
        if (const double coefficient = a[i++]; coefficient != 0)
            out.terms.push_back({coefficient, power});
    return out;
}

Sellmeier sellmeier(const std::vector<double>& a, size_t first, size_t count, double constant) {
    Sellmeier out{{}, constant};
    for (size_t i = first; i < first + count; i += 2)
        if (a[i] != 0) out.terms.push_back({a[i], a[i + 1]});
    return out;
}

decltype(Glass::formula) formula_of(int number, const std::vector<double>& a) {
    switch (number) {
        case 1:
            return series<PowerSeries>(a, {0, 2, -2, -4, -6, -8});
        case 5:
            return series<IndexSeries>(a, {0, -1, -3.5});
        case 9:
            return sellmeier(a, 1, 4, a[0] - 1);
        case 10:
            return series<PowerSeries>(a, {0, 2, -2, -4, -6, -8, -10, -12});
        case 12:
            return series<PowerSeries>(a, {0, 2, -2, -4, -6, -8, 4, 6});
        case 13:
            return series<PowerSeries>(a, {0, 2, 4, -2, -4, -6, -8, -10, -12});
        default:
            return sellmeier(a, 0, kFormulas[size_t(number) - 1].coefficients, 0);
    }
}

double number_or_nan(const std::string& word) {
    return finite_number(word).value_or(std::numeric_limits<double>::quiet_NaN());
}

void append_numbers(std::vector<double>& out, const std::vector<std::string>& line, size_t first) {
    for (size_t i = first; i < line.size(); ++i) out.push_back(number_or_nan(line[i]));
}

}  // namespace

AgfCatalog::AgfCatalog(const std::filesystem::path& path) : AgfCatalog(text_of_file(path), path) {}

AgfCatalog::AgfCatalog(std::string_view text, const std::filesystem::path& file)
    : file_(file.string()), maker_(lower(file.stem().string())) {
    bool in_coefficients = false;
    for (const TextLine& line : text_lines(text, file_)) {
        const auto word = words(line.text);
        if (word.empty()) continue;
        const std::string key = lower(word[0]);
        if (key == "nm" && word.size() > 2)
            entries_.push_back({word[1], line.number, number_or_nan(word[2])});
        if (entries_.empty()) continue;
        Entry& entry = entries_.back();
        // Some catalogues break the line of coefficients; the continuation begins with a number.
        if (in_coefficients && finite_number(word[0])) {
            append_numbers(entry.coefficients, word, 0);
            continue;
        }
        in_coefficients = key == "cd";
        if (in_coefficients) {
            entry.coefficients.clear();
            append_numbers(entry.coefficients, word, 1);
        } else if (key == "ld" && word.size() > 2) {
            entry.first_um = number_or_nan(word[1]);
            entry.last_um = number_or_nan(word[2]);
        } else if (key == "it" && word.size() > 3) {
            const double um = number_or_nan(word[1]), share = number_or_nan(word[2]),
                         mm = number_or_nan(word[3]);
            if (um > 0 && share >= 0 && share <= 1 && mm > 0)
                entry.absorption_per_mm.push_back({um * 1e3, absorption_of(share, mm)});
        }
    }
    if (entries_.empty())
        throw InputError(file_, "", "has no line NM, so no glass; give a glass catalogue (.agf)");
}

std::optional<Glass> AgfCatalog::find(const std::string& name) const {
    const std::string wanted = lower(name);
    for (const Entry& entry : entries_)
        if (lower(entry.name) == wanted) return glass_of(entry);
    return std::nullopt;
}

Glass AgfCatalog::glass_of(const Entry& entry) const {
    const std::string name = printable(entry.name);
    const auto fail = [&](const std::string& message) -> InputError {
        return {file_, fmt::format("line {}", entry.line),
                fmt::format("the glass {} {}", name, message)};
    };
    if (!(entry.formula >= 1 && entry.formula <= double(kFormulas.size()) &&
          entry.formula == std::floor(entry.formula)))
        throw fail("has a dispersion formula that is not one of 1 to 13");
    const int number = static_cast<int>(entry.formula);
    const Formula& formula = kFormulas[size_t(number) - 1];
    if (formula.coefficients == 0)
        throw fail(
            fmt::format("has dispersion formula {} ({}), which Petzval does not know; use "
                        "another glass",
                        number, formula.name));
    if (entry.coefficients.size() < formula.coefficients)
        throw fail(fmt::format("has {} coefficients (CD); its formula {} ({}) needs {}",
                               entry.coefficients.size(), number, formula.name,
                               formula.coefficients));
    for (size_t i = 0; i < formula.coefficients; ++i)
        if (std::isnan(entry.coefficients[i]))
            throw fail(fmt::format("has no number as coefficient {} (CD)", i + 1));
    Glass glass{fmt::format("{}:{}", maker_, entry.name), formula_of(number, entry.coefficients)};
    if (entry.first_um > 0 && entry.first_um < entry.last_um) {
        glass.first_nm = entry.first_um * 1e3;
        glass.last_nm = entry.last_um * 1e3;
    }
    glass.absorption_per_mm = entry.absorption_per_mm;
    std::sort(glass.absorption_per_mm.begin(), glass.absorption_per_mm.end());
    if (!has_index_of_glass(glass))
        throw fail("has coefficients (CD) that give no index from 1 to 5 in the visible");
    return glass;
}

double absorption_of(double transmittance, double thickness_mm) {
    return -std::log(std::max(transmittance, 1e-6)) / thickness_mm;
}

bool has_index_of_glass(const Glass& glass) {
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm)
        if (const double n = glass.index(double(nm)); !(n >= 1 && n <= 5)) return false;
    return true;
}

}  // namespace petzval::io
