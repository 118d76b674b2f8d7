// SPDX-License-Identifier: Apache-2.0
// The tests that hold what a finding of the map of failures says.
#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "io/base/csv.h"
#include "io/base/error.h"

namespace petzval::test {

/// Names of tests, Suite.Name, by the identifier of a finding. Throws InputError.
[[nodiscard]] inline std::map<std::string, std::vector<std::string>> read_guards(
    const std::string& file) {
    const CsvText table = read_csv_text(file);
    std::map<std::string, std::vector<std::string>> guards;
    for (size_t i = 0; i < table.rows.size(); ++i) {
        std::istringstream names(table.rows[i].at(1));
        auto [row, is_new] = guards.try_emplace(table.rows[i].at(0));
        if (!is_new) throw InputError(file, table.place(i), "has a finding for the second time");
        for (std::string name; names >> name;) row->second.push_back(name);
    }
    return guards;
}

}  // namespace petzval::test
