// SPDX-License-Identifier: Apache-2.0
// A small OpenColorIO configuration of ACES kind, as text.
#pragma once

#include <string>

namespace petzval::test {

/// Configuration whose reference is ACES2065-1 and whose scene_linear is ACEScg. The display
/// "Monitor" has the views "Rec709" (linear), "Working" (ACEScg) and "Numbers" (data), "Cinema" has
/// "Half". roles and more: lines of the roles, and further colour spaces.
[[nodiscard]] inline std::string aces_config(
    const std::string& roles = "  aces_interchange: ACES2065-1\n", const std::string& more = "") {
    return "ocio_profile_version: 2\nsearch_path: \"\"\nroles:\n  scene_linear: ACEScg\n  default: "
           "Raw\n" +
           roles +
           R"(displays:
  Cinema:
    - !<View> {name: Half, colorspace: Halves}
  Monitor:
    - !<View> {name: Rec709, colorspace: Out709}
    - !<View> {name: Working, colorspace: ACEScg}
    - !<View> {name: Numbers, colorspace: Raw}
active_displays: [Monitor, Cinema]
colorspaces:
  - !<ColorSpace>
    name: ACES2065-1
  - !<ColorSpace>
    name: ACEScg
    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}
  - !<ColorSpace>
    name: Out709
    from_scene_reference: !<GroupTransform>
      children:
        - !<BuiltinTransform> {style: ACEScg_to_ACES2065-1, direction: inverse}
        - !<BuiltinTransform> {style: UTILITY - ACES-AP1_to_LINEAR-REC709_BFD}
  - !<ColorSpace>
    name: Halves
    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: Raw
    isdata: true
)" + more;
}

/// A colour space with the alias lin_rec709, by the matrix that ACES gives from Rec. 709 to
/// ACES2065-1 (S-2014-004, with a Bradford adaptation).
inline const std::string kNamedRec709 = R"(  - !<ColorSpace>
    name: Studio linear
    aliases: [lin_rec709]
    to_scene_reference: !<MatrixTransform> {matrix: [0.439632982, 0.382988698, 0.177378319, 0, 0.0897764433, 0.813439429, 0.0967841284, 0, 0.0175411704, 0.111546553, 0.870912277, 0, 0, 0, 0, 1]}
)";

}  // namespace petzval::test
