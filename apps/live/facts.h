// SPDX-License-Identifier: Apache-2.0
// What a page is told, as JSON: of the program once, of the scene when it is loaded, of a view
// finder whenever it changes.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/live/page_request.h"
#include "apps/live/viewer.h"

namespace petzval::apps {

/// {"scene": name of the file, "start": fields that the page begins with, "fields": those that a
/// page may set, "lenses": those that ship, "views": of the display}.
[[nodiscard]] nlohmann::json program_facts(const PageRules&);

/// {"cameras", "animations", "variants": of the file, by name}; null where none is loaded.
[[nodiscard]] nlohmann::json scene_facts(const LoadedScene&);

/// The members of a status; messages spell fields as options.
[[nodiscard]] nlohmann::json status_facts(const LiveStatus&);

/// A number in JSON, which has no infinity: that, and what is no number, become null.
[[nodiscard]] nlohmann::json number_or_null(double);

/// Text of JSON; bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string text_of(const nlohmann::json&);

}  // namespace petzval::apps
