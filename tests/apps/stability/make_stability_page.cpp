// SPDX-License-Identifier: Apache-2.0
// Writes the map of failures with the tests that guard each finding, and its tables beside it:
//
//     make_stability_page GUARDS.csv PAGE.md
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <exception>

#include "apps/stability/stability.h"
#include "io/base/atomic_file.h"
#include "tests/apps/stability/guards.h"

namespace petzval {
namespace {

/// The page with one more line at the end of a finding's section.
std::string with_line(std::string page, const Finding& finding, const std::string& line) {
    const size_t start = page.find(fmt::format("\n## {}\n", finding.method));
    const size_t next = page.find("\n## ", start + 1);
    return page.insert(next == std::string::npos ? page.size() : next, line + "\n");
}

void make_page(const std::string& guards_file, const std::filesystem::path& page_file) {
    const auto guards = test::read_guards(guards_file);
    const std::vector<Finding> findings = stability_findings();
    std::string page = stability_markdown(findings);
    for (const Finding& finding : findings)
        page =
            with_line(page, finding,
                      fmt::format("- **Guard:** `{}`", fmt::join(guards.at(finding.id), "`, `")));
    std::filesystem::create_directories(page_file.parent_path());
    write_file_atomically(std::filesystem::path(page_file).replace_extension(".csv"),
                          stability_csv(findings));
    write_file_atomically(page_file, page);
}

}  // namespace
}  // namespace petzval

int main(int count, char** words) {
    if (count != 3) {
        std::fputs("make_stability_page GUARDS.csv PAGE.md\n", stderr);
        return 2;
    }
    try {
        petzval::make_page(words[1], words[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_stability_page: %s\n", error.what());
        return 1;
    }
    return 0;
}
