// SPDX-License-Identifier: Apache-2.0
// What main.cpp makes Python's module of.
#pragma once

#include <pybind11/pybind11.h>

namespace petzval::apps {

/// Adds fields(), the table of those that Python takes, from which _fields.py is made, and
/// check_fields().
void bind_fields(pybind11::module_&);
/// Adds the class Image, and write_exr().
void bind_image(pybind11::module_&);
/// Adds the class Session, plan() and chart().
void bind_session(pybind11::module_&);
/// Adds the class Lens, the optics bench, and lens_names().
void bind_lens(pybind11::module_&);

}  // namespace petzval::apps
