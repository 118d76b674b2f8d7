// SPDX-License-Identifier: Apache-2.0
#include "io/file/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "io/base/error.h"
#include "io/file/read_file.h"
#include "io/file/text_lines.h"

namespace petzval::io {

CsvText read_csv_text(const std::filesystem::path& path, const std::vector<uint8_t>* bytes) {
    std::string text = bytes ? std::string(bytes->begin(), bytes->end()) : text_of_file(path);
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    CsvText table{path.string(), {}, {}, {}};
    int line_number = 0;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = std::string_view(text).substr(begin, end - begin);
        begin = end + 1;
        ++line_number;
        if (line.ends_with('\r')) line.remove_suffix(1);
        const auto refuse = [&](const std::string& message) {
            return InputError(table.file, fmt::format("line {}", line_number), message);
        };
        if (line.find('\r') != line.npos || !is_text(line))
            throw refuse("is not text; save the table as UTF-8 or ASCII");
        line = trimmed(line);
        if (line.empty() || line.starts_with('#')) continue;
        std::vector<std::string> cells;
        for (const std::string_view cell : split(line, ',')) cells.emplace_back(trimmed(cell));
        if (table.names.empty()) {
            table.names = std::move(cells);
            continue;
        }
        if (cells.size() != table.names.size())
            throw refuse(
                fmt::format("number of columns is {}, and {} in the line of names; separate "
                            "columns by commas, write decimals with a point",
                            cells.size(), table.names.size()));
        table.rows.push_back(std::move(cells));
        table.line_of_row.push_back(line_number);
    }
    if (table.rows.empty())
        throw InputError(table.file, fmt::format("line {}", std::max(line_number, 1)),
                         "ends without a row of numbers; write a line of names, then the rows");
    return table;
}

CsvTable read_csv(const std::filesystem::path& path, const std::vector<uint8_t>* bytes) {
    CsvText text = read_csv_text(path, bytes);
    CsvTable table{std::move(text.file), std::move(text.names), {}, std::move(text.line_of_row)};
    if (finite_number(table.names.front()))
        throw InputError(
            table.file, "",
            "has no line of names; put one before the numbers, as wavelength_nm,value");
    for (size_t row = 0; row < text.rows.size(); ++row) {
        std::vector<double>& values = table.rows.emplace_back();
        for (size_t column = 0; column < table.names.size(); ++column) {
            const std::string& cell = text.rows[row][column];
            const std::optional<double> value = finite_number(cell);
            if (!value)
                throw InputError(table.file, table.place(row),
                                 "column {} is not a finite number; write it as 0.25 or 2.5e-1",
                                 column + 1);
            values.push_back(*value);
        }
    }
    return table;
}

std::string csv_text(const std::vector<std::string>& names,
                     const std::vector<std::vector<double>>& rows) {
    std::string text = fmt::format("{}\n", fmt::join(names, ","));
    for (const auto& row : rows) {
        std::vector<std::string> cells;
        for (const double number : row)
            cells.push_back(std::isfinite(number) ? fmt::format("{:.9g}", number) : "");
        text += fmt::format("{}\n", fmt::join(cells, ","));
    }
    return text;
}

}  // namespace petzval::io
