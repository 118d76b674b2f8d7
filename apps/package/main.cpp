// SPDX-License-Identifier: Apache-2.0
// petzval_manual FOLDER: writes manual pages and completions there, from the program's own table.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "apps/commands/all.h"
#include "apps/package/completion.h"
#include "apps/package/man_page.h"
#include "io/build/build.h"

namespace {

namespace apps = petzval::apps;
namespace io = petzval::io;

void write(const std::filesystem::path& to, const std::string& text) {
    std::filesystem::create_directories(to.parent_path());
    std::ofstream file;
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.open(to);
    file << text;
    file.close();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: petzval_manual FOLDER\n", stderr);
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        apps::Session session(apps::ConsoleStyle::Text, true);
        CLI::App app;
        apps::add_all_commands(app, session);
        for (const auto& [name, text] : apps::man_pages(app, io::program_version()))
            write(folder / "man" / name, text);
        write(folder / "bash" / "petzval", apps::bash_completion(app));
        write(folder / "zsh" / "_petzval", apps::zsh_completion(app));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "petzval_manual: %s\n", error.what());
        return 1;
    }
    return 0;
}
