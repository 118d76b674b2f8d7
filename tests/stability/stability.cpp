// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/stability.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <sstream>

#include "core/traversal/bvh.h"
#include "io/base/error.h"
#include "io/file/csv.h"
#include "tests/stability/sweeps.h"

namespace petzval {
namespace {

// As GitHub makes the anchor of a heading.
std::string anchor(const std::string& heading) {
    std::string out;
    for (const unsigned char c : heading)
        if (std::isalnum(c) || c == '-')
            out += static_cast<char>(std::tolower(c));
        else if (c == ' ')
            out += '-';
    return out;
}

std::string table_row(const std::vector<std::string>& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string table_head(const std::vector<std::string>& columns) {
    std::string rule = "|";
    for (size_t i = 0; i < columns.size(); ++i) rule += "---|";
    return table_row(columns) + rule + "\n";
}

std::string section(const Finding& f) {
    std::string out =
        fmt::format("## {}\n{}\n\n{}", f.method, f.sweep, table_head(f.table.columns));
    for (const auto& cells : f.table.rows) out += table_row(cells);
    return out +
           fmt::format("\n- **Fails:** {}. {}\n- **There:** {}\n", f.fails, f.where, f.instead);
}

}  // namespace

std::string stability::number(double a) {
    if (!std::isfinite(a)) return std::isnan(a) ? "NaN" : a > 0 ? "infinity" : "-infinity";
    const double rounded = std::stod(fmt::format("{:.2e}", a));
    const double size = std::fabs(rounded);
    return size == 0 || (size >= 1e-4 && size < 1e5) ? fmt::format("{}", rounded)
                                                     : fmt::format("{:.3g}", rounded);
}

std::string stability::percent(double share) {
    return number(100 * share) + " %";
}

std::vector<Finding> stability_findings() {
    using namespace stability;
    flush_denormals();
    std::vector<Finding> findings;
    for (const Sweep& sweep : kSweeps) {
        findings.push_back(sweep.run());
        findings.back().id = sweep.id;
    }
    return findings;
}

Guards read_guards(const std::string& file) {
    const io::CsvText table = io::read_csv_text(file);
    Guards guards;
    for (size_t i = 0; i < table.rows.size(); ++i) {
        std::istringstream names(table.rows[i].at(1));
        auto [row, is_new] = guards.try_emplace(table.rows[i].at(0));
        if (!is_new)
            throw io::InputError(file, table.place(i), "has a finding for the second time");
        for (std::string name; names >> name;) row->second.push_back(name);
    }
    return guards;
}

std::string stability_markdown(const std::vector<Finding>& findings, const Guards& guards) {
    std::string out =
        "# Where methods fail\n\n"
        "    cmake --build --preset release --target stability_page\n\n"
        "This command wrote the page. For each method it varies the parameters until the method "
        "fails.\nSeeds are fixed: the same program finds the same on the same machine, and nearly "
        "the same on another.\nThe command also writes `stability.csv`, with the numbers of all "
        "tables. The tests after \"Guard\" hold what\nis said; `make test` runs them.\n\n" +
        table_head({"method", "what fails", "where"});
    for (const Finding& f : findings)
        out += table_row({fmt::format("[{}](#{})", f.method, anchor(f.method)), f.fails, f.where});
    for (const Finding& f : findings)
        out +=
            fmt::format("\n{}- **Guard:** `{}`\n", section(f), fmt::join(guards.at(f.id), "`, `"));
    return out;
}

std::string stability_csv(const std::vector<Finding>& findings) {
    std::string out = "finding,method,row,quantity,value\n";
    for (const Finding& f : findings)
        for (size_t i = 0; i < f.table.rows.size(); ++i)
            for (size_t k = 0; k < f.table.columns.size(); ++k)
                out += fmt::format("{},{},{},{},{}\n", f.id, f.method, i + 1, f.table.columns[k],
                                   f.table.rows[i][k]);
    return out;
}

}  // namespace petzval
