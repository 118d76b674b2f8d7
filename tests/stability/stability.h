// SPDX-License-Identifier: Apache-2.0
// The map of failures: for each method the region where it fails, found by going there.
#pragma once

#include <map>
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
    std::string id{};       ///< that of its sweep
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

/// Names of the tests that guard each finding, Suite.Name, by its identifier.
using Guards = std::map<std::string, std::vector<std::string>>;

/// Guards from a file: rows of an identifier and names with spaces between them. Throws InputError.
[[nodiscard]] Guards read_guards(const std::string& file);

/// The page stability.md: a table of all findings, then a section for each. Throws
/// std::out_of_range where a finding has no guard.
[[nodiscard]] std::string stability_markdown(const std::vector<Finding>&, const Guards&);
/// All tables in one: a row for each cell.
[[nodiscard]] std::string stability_csv(const std::vector<Finding>&);

}  // namespace petzval
