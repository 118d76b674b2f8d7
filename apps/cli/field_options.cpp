// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/field_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/request/option_text.h"
#include "apps/request/value_error.h"
#include "io/base/nearest.h"
#include "io/base/printable.h"

namespace petzval::apps {
namespace {

// Word quoted for a shell, where it needs it. What is hidden is written as escapes, which bash, ksh
// and zsh read back between $' and '.
std::string quoted(const std::string& word) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:,=%+@";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    if (io::visible(word) != word) {
        std::string escaped;
        for (const char c : word)
            escaped += c == '\\' || c == '\'' ? std::string("\\") + c : std::string(1, c);
        return "$'" + io::visible(escaped) + "'";
    }
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

// Calls f; what it refuses becomes an error of the command line.
template <class F>
void as_typed(const F& f) {
    try {
        f();
    } catch (const ValueError& error) {
        throw CLI::ValidationError(as_options(error.option()), error.why());
    }
}

CLI::Option* add(CLI::App& app, RenderOrder& order, const RequestField& field) {
    const auto set = [&order, set = field.set](const std::string& text) {
        as_typed([&] { set(order, text); });
    };
    const std::string& letter = field.short_name;
    const std::string name =
        fmt::format("{}--{}", letter.empty() ? "" : "-" + letter + ",", field.name);
    const std::string help = as_options(field.help);
    switch (field.form) {
        case FieldForm::Argument:
            return app.add_option_function<std::string>("SCENE", set, help)->required();
        case FieldForm::Switch:
            return app.add_flag_callback(
                name, [set] { set("on"); }, help);
        case FieldForm::List:
            return app
                .add_option_function<std::vector<std::string>>(
                    name,
                    [set](const std::vector<std::string>& texts) {
                        for (const std::string& text : texts) set(text);
                    },
                    help)
                ->allow_extra_args(false);  // one value each, so that the scene may follow
        default:
            return app.add_option_function<std::string>(name, set, help);
    }
}

void add_in_group(CLI::App& app, RenderOrder& order, const RequestField& field) {
    CLI::Option* const option = add(app, order, field);
    if (!field.group.empty()) option->group(field.group);
    if (field.form != FieldForm::Switch) option->type_name(field.value);
}

// Reads "sampler=sobol".
void set_method(const std::vector<RequestField>& methods, RenderOrder& order,
                const std::string& text) {
    const size_t at = text.find('=');
    const std::string name = text.substr(0, at);
    std::vector<std::string> known;
    for (const RequestField& field : methods) {
        known.push_back(field.name);
        if (field.name != name) continue;
        if (at == text.npos) throw CLI::ValidationError("--method " + name, "needs =VALUE");
        return as_typed([&] { field.set(order, text.substr(at + 1)); });
    }
    throw CLI::ValidationError(
        "--method",
        fmt::format("\"{}\" is none{}", name, io::did_you_mean_or("there are", name, known)));
}

// Declares --method for fields that compare methods; --help all has them below the options.
void add_method_option(CLI::App& app, RenderOrder& order, std::vector<RequestField> methods) {
    std::string footer = "Methods, as --method NAME=VALUE:\n";
    for (const RequestField& field : methods)
        footer += fmt::format("  {:<20}{}\n", field.name, as_options(field.help));
    app.footer(footer);
    app.add_option_function<std::vector<std::string>>(
           "--method",
           [&order, methods = std::move(methods)](const std::vector<std::string>& texts) {
               for (const std::string& text : texts) set_method(methods, order, text);
           },
           "how it is computed, for experts; may be given more than once")
        ->allow_extra_args(false)
        ->type_name("NAME=VALUE");
}

}  // namespace

void add_field_options(CLI::App& app, RenderOrder& order, Taker taker) {
    std::vector<RequestField> methods;
    for (const RequestField& field : request_fields())
        if (!(field.takers & taker))
            continue;
        else if (field.level == FieldLevel::Method)
            methods.push_back(field);
        else
            add_in_group(app, order, field);
    add_method_option(app, order, std::move(methods));
}

void add_field_option(CLI::App& app, RenderOrder& order, std::string_view name) {
    if (const auto field = find_field(name)) add_in_group(app, order, *field);
}

void hide_expert_options(CLI::App& app) {
    if (!app.get_option_no_throw("--method")) return;
    for (const RequestField& field : request_fields())
        if (CLI::Option* const option = app.get_option_no_throw("--" + field.name);
            option && field.form != FieldForm::Argument)
            option->group(field.level == FieldLevel::Common ? "Options" : "");
    app.get_option("--method")->group("");
    app.footer(
        fmt::format("petzval {0} --help all lists all options. An example:\n"
                    "  petzval {0} scene.glb --lens takumar-50mm-f1.2 --focus 2m{1}",
                    app.get_name(),
                    app.get_option_no_throw("--output") ? " -o picture.png"
                    : app.get_option_no_throw("sample") ? " 640,360,0"
                                                        : ""));
}

std::vector<std::string> words_of(const RenderOrder& order) {
    std::vector<std::string> words;
    for (const auto& [name, texts] : fields_of(order)) {
        const auto field = find_field(name);
        const std::string& letter = field->short_name;
        for (const std::string& text : texts) {
            if (field->level == FieldLevel::Method) {
                words.insert(words.end(), {"--method", name + "=" + text});
                continue;
            }
            if (field->form != FieldForm::Argument)
                words.push_back(letter.empty() ? "--" + name : "-" + letter);
            if (field->form != FieldForm::Switch) words.push_back(text);
        }
    }
    return words;
}

std::string render_command(const RenderOrder& order) {
    std::string command = "petzval render";
    for (const std::string& word : words_of(order)) command += " " + quoted(word);
    return command;
}

}  // namespace petzval::apps
