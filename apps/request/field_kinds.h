// SPDX-License-Identifier: Apache-2.0
// Kinds of fields: how their texts become values, and values texts. A member is a function from an
// order to the value in it, for orders that are const and others.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "apps/request/fields.h"
#include "apps/request/parse_choice.h"
#include "apps/request/quantity.h"

namespace petzval::apps {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// Type of the value that a member holds, without its std::optional.
template <class Member>
using FieldHeld =
    std::remove_cvref_t<decltype(std::declval<Member>()(std::declval<RenderOrder&>()))>;
template <class T>
struct Unwrapped {
    using Type = T;
};
template <class T>
struct Unwrapped<std::optional<T>> {
    using Type = T;
};
template <class Member>
using FieldValue = typename Unwrapped<FieldHeld<Member>>::Type;

/// Name of a field in messages.
inline std::string called(const std::string& name) {
    return "⟨" + name + "⟩";
}

/// Field whose text `parse(option, text)` reads and `write(value)` makes.
template <class Member, class Parse, class Write>
RequestField parsed(const std::string& name, Member member, std::string help, Parse parse,
                    Write write) {
    RequestField field;
    field.name = name;
    field.value = "TEXT";
    field.help = std::move(help);
    field.set = [=](RenderOrder& order, const std::string& text) {
        member(order) = parse(called(name), text);
    };
    field.texts = [=](const RenderOrder& order) -> std::vector<std::string> {
        const auto& held = member(order);
        if constexpr (kIsOptional<FieldHeld<Member>>) {
            if (!held) return {};
            return {write(*held)};
        } else {
            return {write(held)};
        }
    };
    return field;
}

/// Field of a number.
template <class Member>
RequestField number(const std::string& name, Member member, const NumberRange& range,
                    std::string help) {
    using T = FieldValue<Member>;
    RequestField field = parsed(
        name, member, std::move(help),
        [=](const std::string& option, const std::string& text) {
            if constexpr (std::is_integral_v<T>)
                return static_cast<T>(
                    parse_whole_number(option, text, uint64_t(range.least), uint64_t(range.most)));
            else
                return static_cast<T>(parse_number(option, text, range));
        },
        [](T value) { return fmt::format("{}", value); });
    field.value = "NUMBER";
    return field;
}

/// Field of a choice that option_names.h lists. absent: the word for none of them, or nothing.
template <class Member>
RequestField choice(const std::string& name, Member member, std::string help,
                    const char* absent = nullptr) {
    using Held = FieldHeld<Member>;
    Choices<Held> words;
    if (absent) words.emplace_back(absent, Held{});
    for (const auto& [word, value] : kOptionNames<FieldValue<Member>>)
        words.emplace_back(word, value);
    RequestField field = parsed(
        name, member, std::move(help),
        [=](const std::string& option, const std::string& text) {
            return parse_choice<Held>(option, text, words);
        },
        [](FieldValue<Member> value) { return name_of(value); });
    field.value = "WORD";
    return field;
}

/// Field of a text or a path. complaint(text): what is wrong with it, or an empty text.
template <class Member, class Complaint>
RequestField text(const std::string& name, Member member, std::string help, Complaint complaint) {
    using T = FieldValue<Member>;
    RequestField field = parsed(
        name, member, std::move(help),
        [=](const std::string& option, const std::string& given) {
            if (const std::string wrong = complaint(given); !wrong.empty())
                throw ValueError(option, wrong);
            return T(given);
        },
        [](const T& value) {
            if constexpr (std::is_same_v<T, std::string>)
                return value;
            else
                return value.string();
        });
    if constexpr (std::is_same_v<T, std::filesystem::path>) field.value = "FILE";
    // An empty one asks for nothing.
    field.texts = [all = field.texts](const RenderOrder& order) {
        auto texts = all(order);
        if (!texts.empty() && texts.front().empty()) texts.clear();
        return texts;
    };
    return field;
}

/// The same without conditions, but that it holds something.
template <class Member>
RequestField text(const std::string& name, Member member, std::string help) {
    return text(name, member, std::move(help), [](const std::string& given) {
        return std::string(given.empty() ? "is empty" : "");
    });
}

/// Field of a list of texts or paths.
template <class Member, class Complaint>
RequestField list(const std::string& name, Member member, std::string help, Complaint complaint) {
    RequestField field;
    field.name = name;
    field.help = std::move(help);
    field.value = "TEXT";
    field.form = FieldForm::List;
    field.set = [=](RenderOrder& order, const std::string& given) {
        if (const std::string wrong = complaint(given); !wrong.empty())
            throw ValueError(called(name), wrong);
        member(order).emplace_back(given);
    };
    field.texts = [=](const RenderOrder& order) {
        std::vector<std::string> texts;
        for (const auto& one : member(order)) texts.push_back(std::filesystem::path(one).string());
        return texts;
    };
    return field;
}

/// The field, as one whose numbers have this between them.
inline RequestField with_between(RequestField field, char between) {
    field.between = between;
    return field;
}
/// The field, as one that most people need.
inline RequestField common(RequestField field) {
    field.level = FieldLevel::Common;
    return field;
}
/// The field, as one for those who compare methods.
inline RequestField method(RequestField field) {
    field.level = FieldLevel::Method;
    return field;
}

/// Field of a switch: `on` where it is given.
template <class Member>
RequestField flag(const std::string& name, Member member, FieldHeld<Member> on, std::string help) {
    RequestField field;
    field.name = name;
    field.help = std::move(help);
    field.form = FieldForm::Switch;
    field.set = [=](RenderOrder& order, const std::string& given) {
        if (given != "on") throw ValueError(called(name), "takes no value");
        member(order) = on;
    };
    field.texts = [=](const RenderOrder& order) -> std::vector<std::string> {
        if (member(order) == on) return {"on"};
        return {};
    };
    return field;
}

}  // namespace petzval::apps
