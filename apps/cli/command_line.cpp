// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string_view>

#include "apps/cli/command_tree.h"
#include "apps/cli/field_options.h"
#include "apps/request/fields.h"
#include "apps/request/file_names.h"
#include "io/base/ascii.h"
#include "io/base/nearest.h"
#include "io/base/printable.h"
#include "io/gltf/validate/foreign.h"

namespace petzval::apps {
namespace {

using Words = std::vector<std::string>;

bool is(const CLI::ParseError& error, CLI::ExitCodes code) {
    return error.get_exit_code() == static_cast<int>(code);
}

bool is_option(const std::string& word) {
    return word.size() > 1 && word[0] == '-' && word != "--";
}

std::string without_value(const std::string& option) {
    return option.substr(0, option.find('='));
}

/// What options of other renderers are called here, by a word that their names hold; by the whole
/// name where it is short.
struct ForeignWord {
    std::string_view word, option, value;
};
constexpr std::array<ForeignWord, 12> kForeign{
    {{"samples", "--spp", "NUMBER"},
     {"width", "--size", "WIDTHxHEIGHT"},
     {"height", "--size", "WIDTHxHEIGHT"},
     {"resolution", "--size", "WIDTHxHEIGHT"},
     {"bounce", "--method", "max-depth=NUMBER"},
     {"hdri", "--env", "FILE"},
     {"tonemap", "--view", "NAME"},
     {"dof", "--fstop", "NUMBER --focus DISTANCE"},
     {"ev", "--exposure", "STOPS"},
     {"fnumber", "--fstop", "NUMBER"},
     {"format", "--output", "FILE, whose ending says the format"},
     {"outfile", "--output", "FILE"}}};

// "; type --size WIDTHxHEIGHT" for --width; empty where the command has nothing of the kind.
std::string as_called_here(const CLI::App& app, std::string typed) {
    constexpr size_t kShort = 3;
    std::erase_if(typed, [](char c) { return c == '-' || c == '_'; });
    for (const auto& [word, option, value] : kForeign)
        if (word.size() > kShort ? typed.find(word) != typed.npos : typed == word)
            if (app.get_option_no_throw(std::string(option)))
                return fmt::format("; type {} {}", option, value);
    return "";
}

// "; did you mean --focus?"; empty where no option that is shown is near.
std::string near_options(const CLI::App& app, const std::string& typed) {
    Words names;
    for (const CLI::Option* option : app.get_options())
        if (!option->get_group().empty())
            names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
    const std::string bare = typed.substr(typed.starts_with("--") ? 2 : 1);
    if (app.get_option_no_throw("--method"))
        for (const RequestField& field : request_fields())
            if (field.level == FieldLevel::Method) names.push_back(field.name);
    Words near = io::words_near(bare, names);
    const auto begins = [&](const std::string& name) { return name.starts_with(bare); };
    if (bare.size() == 1) std::ranges::copy_if(names, std::back_inserter(near), begins);
    for (std::string& name : near)
        if (!app.get_option_no_throw("--" + name)) name = "method " + name;
    constexpr size_t kMost = 3;  // of -s, say, with which many begin
    return near.empty() || near.size() > kMost
               ? ""
               : fmt::format("; did you mean --{}?", fmt::join(near, " or --"));
}

// Commands, anywhere below one, that take an option.
Words takers(const CLI::App& app, const std::string& option) {
    Words found;
    for (const CLI::App* command : commands_of(app)) {
        if (command->get_option_no_throw(option)) found.push_back(full_name(*command));
        const Words below = takers(*command, option);
        found.insert(found.end(), below.begin(), below.end());
    }
    return found;
}

std::string unknown_option(const CLI::App& app, const std::string& option) {
    const std::string what = fmt::format("{} is no option of {}", option, full_name(app));
    if (option.starts_with("--") && app.get_option_no_throw(option.substr(2)))
        return fmt::format("{}; type the {} without it", what, option.substr(2));
    if (const std::string here = as_called_here(app, option); !here.empty()) return what + here;
    for (const CLI::App* at = app.get_parent(); at; at = at->get_parent())
        if (const Words elsewhere = takers(*at, option); !elsewhere.empty())
            return fmt::format("{}; {} has it", what, elsewhere.front());
    return what + near_options(app, option);
}

std::string unknown_command(const CLI::App& app, const std::string& word) {
    Words names;
    for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
    const std::filesystem::path file(word);
    const std::string ending = io::lower(file.extension().string());
    if (!app.get_parent() && (ending == ".glb" || ending == ".gltf"))
        return fmt::format(
            "\"{0}\" is no command; to render it type {1} render {2} -o {3}, to see what is in it "
            "{1} info {2}",
            word, app.get_name(), io::for_shell(word),
            io::for_shell(file.stem().string() + ".png"));
    const std::string foreign = io::foreign_scene_advice(file);
    if (!app.get_parent() && !foreign.empty()) return word + ": " + foreign;
    if (app.get_option_no_throw("--" + word))
        return fmt::format("\"{0}\" is no command; did you mean --{0}?", word);
    return fmt::format("\"{}\" is no command{}", word,
                       io::did_you_mean_or("there are " + full_name(app), word, names));
}

std::string missing_command(const CLI::App& app) {
    Words names;
    for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
    return fmt::format("{} needs a command: {}", full_name(app), fmt::join(names, ", "));
}

// What is wrong at the last command, by the word that it did not take.
std::string about_word(const CLI::App& command, const CLI::ParseError& error,
                       const std::string& word) {
    if (is(error, CLI::ExitCodes::RequiredError) && command.get_option_no_throw("--output") &&
        complaint_about_picture_name(word).empty())
        return fmt::format("{}; did you mean -o {}?", error.what(), io::for_shell(word));
    if (is(error, CLI::ExitCodes::ExtrasError))
        return fmt::format("{} has no place for \"{}\"", full_name(command), word);
    return "";
}

// What is wrong by the words that nothing took; empty where they do not explain it.
std::string by_words_left(const CLI::App& app, const CLI::ParseError& error) {
    const auto below = app.get_subcommands();
    const Words left = app.remaining();
    const auto plain = std::find_if_not(left.begin(), left.end(), is_option);
    const bool wants_command = below.empty() && !commands_of(app).empty();
    if (wants_command && plain != left.end()) return unknown_command(app, *plain);
    for (const std::string& word : left)
        if (is_option(word)) return unknown_option(app, without_value(word));
    if (wants_command) return missing_command(app);
    if (!below.empty()) return by_words_left(*below.front(), error);
    return plain == left.end() ? "" : about_word(app, error, *plain);
}

}  // namespace

void resolve_repeats(CLI::App& app) {
    CLI::Option* const output = app.get_option_no_throw("--output");
    if (output && output->get_expected_max() == 1)
        output->multi_option_policy(CLI::MultiOptionPolicy::Throw);
    for (CLI::App* command : app.get_subcommands(std::function<bool(CLI::App*)>()))
        resolve_repeats(*command);
}

void resolve_help(CLI::App& app, std::vector<std::string>& words) {
    CLI::App* at = &app;
    bool asked = false;
    for (auto word = words.begin(); word != words.end();) {
        if (*word == "help" && !asked && !commands_of(*at).empty()) {
            asked = true;
            word = words.erase(word);
            continue;
        }
        if (is_option(*word)) break;
        const auto commands = at->get_subcommands(std::function<bool(CLI::App*)>());
        const auto named = [&](const CLI::App* command) { return command->get_name() == *word; };
        const auto found = std::find_if(commands.begin(), commands.end(), named);
        if (found == commands.end()) {
            if (asked && !commands.empty())
                throw CLI::ParseError(unknown_command(*at, *word), CLI::ExitCodes::InvalidError);
            break;
        }
        at = *found;
        ++word;
    }
    if (asked) words.insert(std::find(words.begin(), words.end(), "all"), "--help");
    const auto help = std::find_if(words.begin(), words.end(), [](const auto& word) {
        return word == "--help" || word == "-h";
    });
    if (help == words.end()) return;
    if (help + 1 != words.end() && *(help + 1) == "all")
        words.erase(help + 1);
    else
        hide_expert_options(*at);
}

CLI::ParseError no_such_option(const CLI::App& app, const std::string& option) {
    return {unknown_option(app, option), CLI::ExitCodes::InvalidError};
}

std::string explanation(const CLI::App& app, const CLI::ParseError& error) {
    if (is(error, CLI::ExitCodes::InvalidError)) return error.what();  // it explains itself
    std::string what = by_words_left(app, error);
    if (what.empty()) what = error.what();
    if (is(error, CLI::ExitCodes::ArgumentMismatch))
        what = what.substr(0, what.find(':')) + (what.find("At Most") == std::string::npos
                                                     ? " needs a value"
                                                     : " is given twice, and one file is written");
    return what;
}

}  // namespace petzval::apps
