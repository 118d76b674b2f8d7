// SPDX-License-Identifier: Apache-2.0
// The map of failures: for each method the region where it fails, found by going there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace petzval {

/// What a sweep measured, as it is printed: numbers with three digits, no commas in a cell.
struct SweepTable {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;  ///< each as long as columns
};

/// One method and where it ends.
struct Finding {
    std::string id;         ///< words with hyphens, which stay when its section gets another name
    std::string method;     ///< a few words: the name of its section
    std::string fails{};    ///< bias, variance, NaN, no answer; "nothing" within the range swept
    std::string where{};    ///< with the numbers that the sweep found and their units
    std::string instead{};  ///< what the program does there; messages are those that it gave
    std::string sweep{};    ///< what was varied over which range, and what is measured
    SweepTable table{};
};

/// Every sweep, in the order of the report: some seconds of one thread. The same in every run:
/// seeds are fixed and nothing of the machine is in it. Sets denormals to zero on this thread, as
/// rendering does. Throws InputError where assets are missing.
[[nodiscard]] std::vector<Finding> stability_findings();

/// The page stability.md: a table of all findings, then a section for each.
[[nodiscard]] std::string stability_markdown(const std::vector<Finding>&);
/// All tables in one: a row for each cell.
[[nodiscard]] std::string stability_csv(const std::vector<Finding>&);

/// Sweeps, and writes stability.md and stability.csv into a folder, which is made before if need
/// be. Returns the first. Throws InputError.
[[nodiscard]] std::filesystem::path write_stability(const std::filesystem::path& folder);

}  // namespace petzval
