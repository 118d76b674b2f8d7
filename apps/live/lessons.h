// SPDX-License-Identifier: Apache-2.0
// Lessons of the page to learn from: what a formula says of the settings of a picture, beside what
// traced rays do.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "apps/request/render_order.h"

namespace petzval::apps {

/// {"plots": [{"title", "x" and "y": [from, to, what], "series": [{"name", "style", "paths"}]}],
/// "figures": [name, text]} of a lesson for the lens, iris and focus of an order. style: a class of
/// the page; "dots..." are points, the others lines. Throws ValueError for a lesson that there is
/// not, InputError where the lens is none for it or images nothing.
[[nodiscard]] nlohmann::json lesson_facts(const std::string& lesson, const RenderOrder&);

}  // namespace petzval::apps
