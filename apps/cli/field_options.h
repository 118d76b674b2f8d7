// SPDX-License-Identifier: Apache-2.0
// Options of the command line, from the table of fields.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/request/fields.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace petzval::apps {

/// Declares the options of all fields that a command takes; they write to the order, which must
/// outlive the parsing.
void add_field_options(CLI::App&, RenderOrder&, Taker);

/// Declares the option of one field, likewise.
void add_field_option(CLI::App&, RenderOrder&, std::string_view name);

/// Hides the options that most people do not need from --help, and says how to see them.
void hide_expert_options(CLI::App&);

/// Words of a command line that asks for an order, without the command's name. A word that is no
/// option follows the option that it is for.
[[nodiscard]] std::vector<std::string> words_of(const RenderOrder&);

/// Command that renders an order, quoted for a shell where that is needed.
[[nodiscard]] std::string render_command(const RenderOrder&);

}  // namespace petzval::apps
