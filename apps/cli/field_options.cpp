// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/field_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/request/option_text.h"
#include "apps/request/value_error.h"

namespace petzval {
namespace {

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
            return app.add_option_function<std::string>("scene", set, help)->required();
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

}  // namespace

void add_field_options(CLI::App& app, RenderOrder& order, Taker taker) {
    for (const RequestField& field : request_fields())
        if (field.takers & taker) add_in_group(app, order, field);
}

void add_field_option(CLI::App& app, RenderOrder& order, std::string_view name) {
    if (const auto field = find_field(name)) add_in_group(app, order, *field);
}

std::vector<std::string> words_of(const RenderOrder& order) {
    std::vector<std::string> words;
    for (const auto& [name, texts] : fields_of(order)) {
        const auto field = find_field(name);
        const std::string& letter = field->short_name;
        for (const std::string& text : texts) {
            if (field->form != FieldForm::Argument)
                words.push_back(letter.empty() ? "--" + name : "-" + letter);
            if (field->form != FieldForm::Switch) words.push_back(text);
        }
    }
    return words;
}

}  // namespace petzval
