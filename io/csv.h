// SPDX-License-Identifier: Apache-2.0
// Tables of numbers as text.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace petzval {

/// Columns of finite numbers under one line of names, separated by commas. Lines that begin with #
/// and empty lines are comments.
struct CsvTable {
    std::string file;
    std::vector<std::string> names;
    std::vector<std::vector<double>> rows;  ///< each as long as names; at least one
    std::vector<int> line_of_row;           ///< for messages, from 1

    /// "line N", for InputError's place.
    [[nodiscard]] std::string place(size_t row) const;
};

/// Throws InputError with the line: a missing or broken number, a row too short or too long, no
/// row, a file that cannot be read or is not text.
[[nodiscard]] CsvTable read_csv(const std::filesystem::path&);

}  // namespace petzval
