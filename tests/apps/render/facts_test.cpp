// SPDX-License-Identifier: Apache-2.0
// Facts of a render: every field that changes pixels changes them, so that samples of different
// requests are never added, and no stale picture counts as finished.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "apps/render/render_session.h"
#include "apps/request/fields.h"
#include "tests/support/moving_gltf.h"

namespace petzval::apps {
namespace {

using Wishes = std::vector<std::pair<std::string, std::string>>;

/// A value of a field that is not its default, and what must be asked with it to have any effect.
struct Change {
    std::string text;
    Wishes with;
};

const Wishes kThin = {{"focal-length", "50"}, {"fstop", "2"}};
const Wishes kGlass = {{"lens", "takumar-50mm-f1.2"}};
const Wishes kSinglet = {{"lens", "singlet:N-BK7"}, {"focal-length", "50"}, {"fstop", "4"}};
const Wishes kMoving = {{"at", "0.5s"}, {"shutter", "0.1s"}};
const Wishes kWavelengths = {{"spectral", "wavelengths"}};
const Wishes kPhotographic = {
    {"exposure-mode", "photographic"}, {"focal-length", "50"}, {"fstop", "2"}};

/// One for each field of a picture. Left out: how many samples there are is said by their range; a
/// tolerance acts by the choices that it leads to.
const std::map<std::string, Change> kChanges{
    {"file", {"", {}}},  // the other file
    {"seed", {"7", {}}},
    {"noise", {"5%", {}}},
    {"denoise", {"on", {}}},
    {"size", {"20x10", {}}},
    {"crop", {"1,2,3,4", {}}},
    {"variant", {"red", {}}},
    {"scene", {"1", {}}},
    {"point-line-radius", {"2mm", {}}},
    {"at", {"0.25s", {}}},
    {"fps", {"30", {{"at", "frame:12"}}}},
    {"animation", {"turn", {{"at", "0.5s"}}}},
    {"loop", {"on", {{"at", "1.5s"}}}},
    {"max-depth", {"3", {}}},
    {"max-clear-depth", {"7", {}}},
    {"filter", {"box", {}}},
    {"filter-radius", {"0.7", {}}},
    {"sampler", {"sobol", {}}},
    {"light-choice", {"power", {}}},
    {"targets", {"off", {}}},
    {"clamp", {"1000", {}}},
    {"traversal", {"fast", {}}},
    {"env", {"studio", {}}},
    {"env-rotate", {"30", {{"env", "studio"}}}},
    {"env-strength", {"2", {{"env", "studio"}}}},
    {"background", {"0,0.3,0.1", {}}},
    {"transparent", {"on", {}}},
    {"spectral", {"wavelengths", {}}},
    {"bins", {"380:730:10", kWavelengths}},
    {"illuminant", {"a", kWavelengths}},
    {"response", {PETZVAL_ASSETS "/spectra/cie1931.csv", kWavelengths}},
    {"white-balance", {"illuminant", kWavelengths}},
    {"camera", {"right", {}}},
    {"look-at", {"0,1,3,0,0,-1", {}}},
    {"pose", {"0,1,0,0,-1,0,0,1,0,0,1,3", {}}},
    {"orbit", {"90", {}}},
    {"orbit-about", {"1,2,3", {{"orbit", "30"}}}},
    {"fov", {"41", {}}},
    {"sensor", {"30x20", kThin}},
    {"focus", {"2.5m", kThin}},
    {"fstop", {"4", {{"focal-length", "50"}}}},
    {"lens-radius", {"1cm", {}}},
    {"focal-length", {"40", {{"fstop", "2"}}}},
    {"film-distance", {"51mm", {{"focal-length", "50"}, {"fstop", "2"}}}},
    {"lens", {"takumar-50mm-f1.2", {}}},
    {"focus-by", {"traced", kGlass}},
    {"fit", {"fov", kGlass}},
    {"aperture", {"star:5", kThin}},
    {"aperture-scale",
     {"inscribed", {{"focal-length", "50"}, {"fstop", "2"}, {"aperture", "star:5"}}}},
    {"iris-sampling", {"rejection", kThin}},
    {"dispersion", {"hero", kSinglet}},
    {"coating", {"mgf2", kGlass}},
    {"ghosts", {"off", kGlass}},
    {"diffraction", {"auto", kThin}},
    {"lens-precision", {"double", kGlass}},
    {"exposure-mode", {"photographic", kThin}},
    {"natural-vignetting", {"off", kPhotographic}},
    {"iso", {"3200", kPhotographic}},
    {"shutter", {"1/10s", {{"at", "0.5s"}}}},
    {"shutter-curve", {"trapezoid", kMoving}},
    {"exposure", {"1", {}}},
    {"view", {"raw", {}}},
    {"aov", {"depth", {}}},
};
/// glasses: catalogues that a lens names; ocio: needs a file. Both are among the files of a render.
const std::set<std::string> kByOthers = {"spp", "time-limit", "tolerance", "glasses", "ocio"};

/// A triangle in two variants and a point, in two scenes, two cameras that do not move, and two
/// animations.
std::filesystem::path everything(const TempFolder& folder, const char* name, float size) {
    TinyGltf file;
    const int mesh = file.add_triangle({{"material", 0}});
    auto& json = file.json;
    json["materials"] = {{{"name", "plain"}}, {{"name", "red"}}};
    auto& primitive = json["meshes"][mesh]["primitives"][0];
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {0}}}};
    json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}};
    json["extensionsUsed"] = {"KHR_materials_variants"};
    auto points = primitive;
    points["mode"] = 0;
    json["meshes"][mesh]["primitives"].push_back(points);
    json["cameras"] = {{{"name", "left"},
                        {"type", "perspective"},
                        {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}},
                       {{"name", "right"},
                        {"type", "perspective"},
                        {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}}};
    file.add_root({{"mesh", mesh}, {"scale", {size, size, size}}});
    file.add_root({{"camera", 0}, {"translation", {0, 0, 4}}});
    file.add_root({{"camera", 1}, {"translation", {0.5, 0, 4}}});
    json["scenes"].push_back(json["scenes"][0]);
    test::animate(file, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
    json["animations"][0]["name"] = "shift";
    json["animations"].push_back(json["animations"][0]);
    json["animations"][1]["name"] = "turn";
    json["animations"][1]["channels"][0]["target"]["path"] = "scale";
    return file.save_glb(folder.path / name);
}

std::string facts_of(RenderSession& session, const RenderOrder& order) {
    session.prepare(order.render, [](const std::string&) {});
    const SampleRange samples{0, 1};
    return light_hash(session.facts(), session.shape(), samples) +
           display_hash(session.facts().display);
}

TEST(RenderFacts, EachFieldOfThePictureChangesThem) {
    const TempFolder folder;
    const auto file = everything(folder, "a.glb", 1), other = everything(folder, "b.glb", 0.5f);
    RenderSession session(1);
    size_t tried = 0;
    for (const RequestField& field : request_fields()) {
        if (field.part != FieldPart::Picture || kByOthers.count(field.name)) continue;
        const auto known = kChanges.find(field.name);
        ASSERT_NE(known, kChanges.end()) << field.name << " needs a change";
        RenderOrder order;
        order.render.scene.scene = file;
        order.render.scene.size = {24, 16};
        order.render.scene.background = Rgb(0.2f, 0.2f, 0.2f);  // or the studio would light it
        for (const auto& [name, text] : known->second.with) find_field(name)->set(order, text);
        RenderOrder changed = order;
        field.set(changed, field.name == "file" ? other.string() : known->second.text);
        try {
            EXPECT_NE(facts_of(session, order), facts_of(session, changed)) << field.name;
        } catch (const std::exception& error) {
            ADD_FAILURE() << field.name << ": " << error.what();
        }
        ++tried;
    }
    EXPECT_EQ(tried, kChanges.size());
}

}  // namespace
}  // namespace petzval::apps
