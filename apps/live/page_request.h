// SPDX-License-Identifier: Apache-2.0
// What a page asks for: a request in the names and texts of the table of fields.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/request/fields.h"

namespace petzval::apps {

/// Whether a page may set a field: those that change pixels, but for the scene.
[[nodiscard]] bool is_for_pages(const RequestField&);

/// What holds for every request of a server.
struct PageRules {
    RenderOrder start;                           ///< of the command line: scene, memory, scope
    std::vector<std::filesystem::path> folders;  ///< in which files may lie that a page names
};

/// Rules of an order: files may lie in the folder of its scene, among the program's own, or be
/// those that it names.
[[nodiscard]] PageRules rules_of(RenderOrder);

/// Fields of an order that a page may set, as {"fstop": ["2"], ...}.
[[nodiscard]] nlohmann::json fields_for_page(const RenderOrder&);

/// Order of a page: the fields that it sets, in place of those that the server started with. Throws
/// ValueError, with the name of the field, where a text is none that the field takes or names a
/// file that the rules leave out.
[[nodiscard]] RenderOrder order_of_page(const nlohmann::json& fields, const PageRules&);

}  // namespace petzval::apps
