// SPDX-License-Identifier: Apache-2.0
#include "io/glass/catalogue.h"

#include <algorithm>
#include <charconv>
#include <span>
#include <string_view>
#include <tuple>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/nearest.h"
#include "io/file/assets.h"
#include "io/file/csv.h"
#include "io/glass/agf.h"

namespace petzval::io {
namespace {

// Columns of assets/glass/catalog.csv.
enum Column : size_t { Maker, Name, Formula, Coefficients, First_nm, Last_nm };

std::string full_name(const std::vector<std::string>& row) {
    return row[Maker] + ":" + row[Name];
}

// Name without what people leave out of it or add: hyphens and spaces.
std::string bare(std::string name) {
    std::erase_if(name, [](char c) { return c == '-' || c == ' '; });
    return name;
}

// Numbers with one space between; nothing where a text is anything else.
std::vector<double> numbers(std::string_view text) {
    std::vector<double> values;
    const char *at = text.data(), *end = at + text.size();
    while (true) {
        const auto [stop, error] = std::from_chars(at, end, values.emplace_back());
        if (error != std::errc() || (stop != end && *stop != ' ')) return {};
        if (stop == end) return values;
        at = stop + 1;
    }
}

std::vector<std::array<double, 2>> pairs(std::span<const double> values) {
    std::vector<std::array<double, 2>> result;
    for (size_t i = 0; i + 1 < values.size(); i += 2) result.push_back({values[i], values[i + 1]});
    return result;
}

Glass parse(const CsvText& catalog, size_t index) {
    const std::vector<std::string>& row = catalog.rows[index];
    const std::vector<double> a = numbers(row[Coefficients]), first = numbers(row[First_nm]),
                              last = numbers(row[Last_nm]);
    const bool sellmeier = row[Formula] == "sellmeier", power = row[Formula] == "power";
    if (first.size() != 1 || last.size() != 1 || a.empty() || a.size() % 2 != size_t(power) ||
        sellmeier == power)
        throw InputError(catalog.file, catalog.place(index),
                         "is not a glass; install Petzval again with cmake --install");
    Glass glass{full_name(row), {}, first[0], last[0]};
    if (sellmeier) {
        glass.formula = Sellmeier{pairs(a)};
    } else {
        PowerSeries series{pairs(std::span(a).subspan(1))};
        series.terms.push_back({a[0], 0});
        glass.formula = std::move(series);
    }
    return glass;
}

// Adds what assets/glass/transmittance.csv says of glasses: pairs of nm and the internal
// transmittance of 10 mm. Both files are sorted by maker and name.
void add_absorption(std::vector<Glass>& glasses) {
    constexpr double thickness_mm = 10;
    const CsvText known = read_csv_text(asset("glass/transmittance.csv"));
    auto glass = glasses.begin();
    for (size_t i = 0; i < known.rows.size(); ++i) {
        const auto& row = known.rows[i];
        glass = std::find_if(glass, glasses.end(),
                             [name = full_name(row)](const Glass& g) { return g.name == name; });
        const auto points = pairs(numbers(row.back()));
        if (glass == glasses.end() || points.empty())
            throw InputError(known.file, known.place(i),
                             "is not a glass; install Petzval again with cmake --install");
        for (const auto& [nm, share] : points)
            glass->absorption_per_mm.push_back({nm, absorption_of(share, thickness_mm)});
    }
}

CsvText read_catalog() {
    CsvText catalog = read_csv_text(asset("glass/catalog.csv"));
    if (catalog.names.size() <= Last_nm)
        throw InputError(catalog.file, "",
                         "is not a catalogue; install Petzval again with cmake --install");
    return catalog;
}

}  // namespace

std::vector<Glass> glass_catalog() {
    const CsvText catalog = read_catalog();
    std::vector<Glass> glasses;
    for (size_t i = 0; i < catalog.rows.size(); ++i) glasses.push_back(parse(catalog, i));
    add_absorption(glasses);
    return glasses;
}

std::vector<std::string> glasses_near(const std::string& text) {
    // Text cut to 64 letters: no name is nearly as long, and the distance takes time in proportion.
    const std::string wanted = lower(text.substr(0, 64));
    const size_t colon = wanted.find(':');
    const std::string maker = colon == wanted.npos ? "" : wanted.substr(0, colon);
    const std::string name = bare(colon == wanted.npos ? wanted : wanted.substr(colon + 1));

    const CsvText catalog = read_catalog();
    // Rank of each glass: edit distance, difference in length, name.
    std::vector<std::tuple<size_t, size_t, std::string>> ranked;
    for (const auto& row : catalog.rows) {
        const std::string candidate = bare(lower(row[Name]));
        const bool contained = candidate.find(name) != candidate.npos;
        // A wrong maker weighs no more than two letters: the name tells more.
        const size_t makers =
            maker.empty() ? 0 : std::min<size_t>(2, edit_distance(maker, row[Maker]));
        const size_t length =
            std::max(candidate.size(), name.size()) - std::min(candidate.size(), name.size());
        ranked.emplace_back(makers + (contained ? 0 : edit_distance(name, candidate)), length,
                            full_name(row));
    }
    const size_t count = std::min<size_t>(5, ranked.size());
    std::partial_sort(ranked.begin(), ranked.begin() + std::ptrdiff_t(count), ranked.end());
    std::vector<std::string> near;
    for (size_t i = 0; i < count; ++i) near.push_back(std::move(std::get<2>(ranked[i])));
    return near;
}

}  // namespace petzval::io
