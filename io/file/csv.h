// SPDX-License-Identifier: Apache-2.0
// CSV tables: one line of names, then rows, separated by commas. Lines that begin with # and empty
// lines are comments.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace petzval::io {

/// Table whose cells are text without the spaces around it, or finite numbers.
template <class Cell>
struct Table {
    std::string file;
    std::vector<std::string> names;
    std::vector<std::vector<Cell>> rows;  ///< each as long as names; at least one
    std::vector<int> line_of_row;         ///< for messages, from 1

    /// "line N", for InputError's place.
    [[nodiscard]] std::string place(size_t row) const {
        return "line " + std::to_string(line_of_row[row]);
    }
};
using CsvText = Table<std::string>;
using CsvTable = Table<double>;

/// Reads a table of texts. Throws InputError with the line: a row too short or too long, no row, a
/// file over 16 MiB, one that cannot be read or is not text. bytes: as in read_csv.
[[nodiscard]] CsvText read_csv_text(const std::filesystem::path&,
                                    const std::vector<uint8_t>* bytes = nullptr);

/// Reads a table of numbers. Throws as read_csv_text does, and for a missing or broken number, one
/// that is not finite, or no line of names. bytes: the file's, where they were read already.
[[nodiscard]] CsvTable read_csv(const std::filesystem::path&,
                                const std::vector<uint8_t>* bytes = nullptr);

/// CSV text of names, which must have no commas, and rows. A number that is not finite is an empty
/// cell.
[[nodiscard]] std::string csv_text(const std::vector<std::string>& names,
                                   const std::vector<std::vector<double>>& rows);

}  // namespace petzval::io
