// SPDX-License-Identifier: Apache-2.0
// petzval image sheet and crop: new pictures made of others.
#pragma once

namespace CLI {
class App;
}

namespace petzval {

/// Adds the subcommand "sheet", which puts pictures side by side with their labels; its callback
/// does the work and throws InputError.
void add_sheet(CLI::App& image);
/// Adds the subcommand "crop", which cuts pixels out of a picture, likewise.
void add_crop(CLI::App& image);

}  // namespace petzval
