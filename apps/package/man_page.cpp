// SPDX-License-Identifier: Apache-2.0
#include "apps/package/man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/cli/command_tree.h"

namespace petzval::apps {
namespace {

// Text as roff reads it: a hyphen is one that can be typed, and no line is a request.
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const bool at_start = out.empty() || out.back() == '\n';
        if (at_start && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

// One word of a request.
std::string roff_word(const std::string& text) {
    std::string out;
    for (const char c : roff(text)) out += c == '"' ? "\"\"" : std::string(1, c);
    return '"' + out + '"';
}

std::string entry(const CLI::Option& option) {
    std::string names = fmt::format("{}", fmt::join(names_of(option), ", "));
    if (names.empty()) names = option.get_name();
    std::string head = fmt::format("\\fB{}\\fR", roff(names));
    if (takes_value(option) && is_named(option))
        head += fmt::format(" \\fI{}\\fR", roff(option.get_type_name()));
    return fmt::format(".TP\n{}\n{}\n", head, roff(option.get_description()));
}

std::string synopsis(const CLI::App& app) {
    std::string out = fmt::format("\\fB{}\\fR", roff(full_name(app)));
    if (!options_of(app).empty()) out += " [\\fIOPTIONS\\fR]";
    for (const CLI::Option* argument : arguments_of(app)) {
        const std::string name = roff(argument->get_name());
        out += argument->get_required() ? fmt::format(" \\fI{}\\fR", name)
                                        : fmt::format(" [\\fI{}\\fR]", name);
    }
    if (!commands_of(app).empty()) out += " \\fICOMMAND\\fR";
    return out + "\n";
}

// Arguments, then the options by their groups.
std::string tables(const CLI::App& app, const char* heading) {
    std::string out;
    const auto section = [&](const std::string& title, const auto& options) {
        if (options.empty()) return;
        out += fmt::format("{} {}\n", heading, roff_word(title));
        for (const CLI::Option* option : options) out += entry(*option);
    };
    section("Arguments", arguments_of(app));
    for (const std::string& group : app.get_groups()) {
        auto options = options_of(app);
        std::erase_if(options, [&](const CLI::Option* o) { return o->get_group() != group; });
        section(group, options);
    }
    return out;
}

std::string page(const CLI::App& app, const std::string& version) {
    std::string name = full_name(app);
    std::ranges::replace(name, ' ', '-');
    std::string out = fmt::format(".TH {} 1 \"\" {} {}\n", roff_word(name), roff_word(version),
                                  roff_word("User Commands"));
    out += fmt::format(".SH NAME\n{} \\- {}\n", roff(name), roff(app.get_description()));
    out += ".SH SYNOPSIS\n" + synopsis(app) + tables(app, ".SH");
    const bool is_root = !app.get_parent();
    if (!commands_of(app).empty()) out += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) {
        const std::string what = roff(command->get_description());
        if (is_root)
            out += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", roff("petzval-" + command->get_name()),
                               what);
        else
            out += fmt::format(".SS {}\n{}\n.PP\n{}", roff_word(full_name(*command)), what,
                               synopsis(*command)) +
                   tables(*command, ".PP\n.B");
    }
    // The footer's lines stay lines.
    if (const std::string& footer = app.get_footer(); !footer.empty())
        out += fmt::format(".SH NOTES\n.nf\n{}\n.fi\n", roff(footer));
    if (!is_root) out += ".SH SEE ALSO\n.BR petzval (1)\n";
    return out;
}

}  // namespace

std::map<std::string, std::string> man_pages(const CLI::App& app, const std::string& version) {
    std::map<std::string, std::string> out;
    out["petzval.1"] = page(app, version);
    for (const CLI::App* command : commands_of(app))
        out[fmt::format("petzval-{}.1", command->get_name())] = page(*command, version);
    return out;
}

}  // namespace petzval::apps
