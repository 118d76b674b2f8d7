// SPDX-License-Identifier: Apache-2.0
// The eight kinds of scenes for plans. Each fills a world that holds nothing but its dice.
#pragma once

#include "tests/support/plan_scenes/world.h"

namespace petzval::test {

/// Small dispersing prisms and gems before bright bars, or beside small lamps.
void add_prisms(PlanWorld&);
/// Small lamps out of focus.
void add_lamps(PlanWorld&);
/// Bars as narrow as pixels in a corner of a lens with lateral colour.
void add_barcode(PlanWorld&);
/// Small glossy balls under a small lamp.
void add_glints(PlanWorld&);
/// Light of a small lamp that glass gathers on a floor.
void add_caustics(PlanWorld&);
/// Textures with texels as small as pixels.
void add_textures(PlanWorld&);
/// Metals, lamps with spectra of their own, and colours that many reflections deepen.
void add_spectra(PlanWorld&);
/// Bright small things near the rim of a picture.
void add_rim(PlanWorld&);

}  // namespace petzval::test
