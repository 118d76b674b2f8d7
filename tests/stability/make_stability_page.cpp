// SPDX-License-Identifier: Apache-2.0
// Writes the map of failures, and its tables beside it:
//
//     make_stability_page GUARDS.csv PAGE.md
#include <cstdio>
#include <exception>

#include "io/file/atomic_file.h"
#include "tests/stability/stability.h"

int main(int count, char** words) {
    using namespace petzval;
    if (count != 3) {
        std::fputs("make_stability_page GUARDS.csv PAGE.md\n", stderr);
        return 2;
    }
    try {
        const Guards guards = read_guards(words[1]);
        const std::filesystem::path page = words[2];
        std::filesystem::create_directories(page.parent_path());
        const std::vector<Finding> findings = stability_findings();
        io::write_file_atomically(std::filesystem::path(page).replace_extension(".csv"),
                                  stability_csv(findings));
        io::write_file_atomically(page, stability_markdown(findings, guards));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_stability_page: %s\n", error.what());
        return 1;
    }
    return 0;
}
