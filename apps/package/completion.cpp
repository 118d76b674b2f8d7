// SPDX-License-Identifier: Apache-2.0
#include "apps/package/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/cli/command_tree.h"

namespace petzval::apps {
namespace {

using Words = std::vector<std::string>;

/// A command, and all below it.
std::vector<const CLI::App*> all_commands(const CLI::App& app) {
    std::vector<const CLI::App*> out{&app};
    for (const CLI::App* command : commands_of(app))
        for (const CLI::App* below : all_commands(*command)) out.push_back(below);
    return out;
}

// Lines of a case that go from a command to one below it, as words are read; the shell's variables
// are `command` and `word`.
std::string steps(const CLI::App& app) {
    Words names;
    for (const CLI::App* command : all_commands(app))
        if (command->get_parent()) names.push_back('"' + full_name(*command) + '"');
    return fmt::format(
        "        case \"$command $word\" in\n            {}) "
        "command=\"$command $word\" ;;\n        esac\n",
        fmt::join(names, " | "));
}

// A word of zsh in single quotes.
std::string zsh_word(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

// With a backslash before each of these characters.
std::string escaped(const std::string& text, const std::string& characters) {
    std::string out;
    for (const char c : text) {
        if (characters.find(c) != std::string::npos) out += '\\';
        out += c;
    }
    return out;
}

std::string zsh_option(const CLI::Option& option) {
    const Words names = names_of(option);
    std::string out;
    for (const std::string& name : names) {
        std::string spec = name + '[' + escaped(option.get_description(), "[]\\") + ']';
        if (option.get_items_expected_max() > 1) spec = '*' + spec;
        if (takes_value(option))
            spec += ':' + escaped(option.get_type_name(), ":\\") + ':' +
                    (may_take_file(option) ? "_files" : "");
        out += ' ' + zsh_word(spec);
    }
    return out;
}

std::string zsh_command(const CLI::App& app) {
    const auto commands = commands_of(app);
    std::string out = fmt::format("    ({})\n", zsh_word(full_name(app)));
    if (!commands.empty()) {
        Words lines;
        for (const CLI::App* command : commands)
            lines.push_back(
                zsh_word(escaped(command->get_name(), ":\\") + ':' + command->get_description()));
        out += fmt::format("        commands=({})\n        _describe command commands ;;\n",
                           fmt::join(lines, " "));
        return out;
    }
    out += "        _arguments";
    for (const CLI::Option* option : options_of(app)) out += zsh_option(*option);
    return out + " '*:file:_files' ;;\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
    std::string out = "# Completion of petzval for bash; made with the program.\n";
    out +=
        "_petzval() {\n"
        "    local typed=${COMP_WORDS[COMP_CWORD]} command=petzval word words\n"
        "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n";
    out += steps(app) + "    done\n    case $command in\n";
    for (const CLI::App* command : all_commands(app)) {
        Words words;
        for (const CLI::App* below : commands_of(*command)) words.push_back(below->get_name());
        for (const CLI::Option* option : options_of(*command))
            for (const std::string& name : names_of(*option)) words.push_back(name);
        out += fmt::format("        \"{}\") words=\"{}\" ;;\n", full_name(*command),
                           fmt::join(words, " "));
    }
    // Without an answer bash completes file names.
    return out +
           "    esac\n"
           "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$typed\")\n"
           "    if [[ -z $typed && $words == -* ]]; then COMPREPLY=(); fi\n"
           "}\n"
           "complete -o default -F _petzval petzval\n";
}

std::string zsh_completion(const CLI::App& app) {
    std::string out = "#compdef petzval\n# Completion of petzval for zsh; made with the program.\n";
    out +=
        "_petzval() {\n    local command=petzval word\n    local -a commands\n"
        "    for word in ${words[2,CURRENT-1]}; do\n" +
        steps(app) + "    done\n    case $command in\n";
    for (const CLI::App* command : all_commands(app)) out += zsh_command(*command);
    return out + "    esac\n}\n_petzval \"$@\"\n";
}

}  // namespace petzval::apps
