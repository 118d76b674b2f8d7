// SPDX-License-Identifier: Apache-2.0
// Table of the fields of an order: the one place that knows how a field is called, what it takes,
// and what it is by itself. Options, --help, states, sweeps and the command of a plan follow from
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/request/render_order.h"

namespace petzval::apps {

/// Commands that take fields; a field has a bit for each.
enum Taker : uint8_t { kRender = 1, kPlan = 2, kChart = 4, kInfo = 8, kTrace = 16, kLive = 32 };
/// The commands that render pictures.
inline constexpr uint8_t kPictures = kRender | kPlan | kChart;

/// Part of a render that a field changes.
enum class FieldPart : uint8_t {
    Picture,  ///< its pixels
    Run,      ///< the way there: memory, threads
    Files     ///< what is written and printed, of a whole sequence
};

/// Form of a field: a value; one that a command line has without an option before it; a list that
/// each value is added to; or a switch, whose value is "on".
enum class FieldForm : uint8_t { Value, Argument, List, Switch };

/// Who needs a field: most people; some; those who compare methods. The last are written as
/// --method NAME=VALUE.
enum class FieldLevel : uint8_t { Common, More, Method };

struct RequestField {
    std::string name;        ///< as "fstop"
    std::string short_name;  ///< of one letter, as "o"; or empty
    std::string value;       ///< what --help calls its value: NUMBER, WORD, FILE, TEXT
    std::string group, help;
    uint8_t takers = kRender;
    FieldPart part = FieldPart::Picture;
    FieldForm form = FieldForm::Value;
    FieldLevel level = FieldLevel::More;
    char between = ',';  ///< numbers of a text that holds several
    /// Reads a value from its text. Throws ValueError.
    std::function<void(RenderOrder&, const std::string& text)> set;
    /// Texts from which set() reads what an order holds; none where it holds nothing.
    std::function<std::vector<std::string>(const RenderOrder&)> texts;
};

/// All fields, in the order of --help.
[[nodiscard]] std::vector<RequestField> request_fields();

/// Field of a name; nothing where there is none.
[[nodiscard]] std::optional<RequestField> find_field(std::string_view name);

/// A field with its texts.
struct FieldTexts {
    std::string name;
    std::vector<std::string> texts;
};

/// Fields in which an order differs from one that asks for nothing.
[[nodiscard]] std::vector<FieldTexts> fields_of(const RenderOrder&);

/// Order with these fields. Throws ValueError, also for a name that no field has.
[[nodiscard]] RenderOrder order_of(const std::vector<FieldTexts>&);

}  // namespace petzval::apps
