// SPDX-License-Identifier: Apache-2.0
// The table of fields: texts become values, and values the same texts.
#include "apps/request/fields.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "apps/request/sequence.h"
#include "apps/request/value_error.h"
#include "core/film/spectral_film.h"

namespace petzval::apps {
namespace {

/// A text for each field, which is not its default, and what is written for it.
const std::map<std::string, std::pair<std::string, std::string>> kTexts{
    {"file", {"a b.glb", "a b.glb"}},
    {"spp", {"010", "10"}},
    {"time-limit", {"1h30m", "5400"}},
    {"seed", {"4294967295", "4294967295"}},
    {"noise", {"5%", "0.05"}},
    {"denoise", {"on", "on"}},
    {"size", {"64 X 48", "64x48"}},
    {"crop", {"1, 2, 3, 4", "1,2,3,4"}},
    {"tolerance", {"2.5%", "0.025"}},
    {"threads", {"3", "3"}},
    {"max-memory", {"1 GiB", "1048576KiB"}},
    {"confine", {"on", "on"}},
    {"variant", {"red", "red"}},
    {"scene", {"2", "2"}},
    {"point-line-radius", {"2mm", "0.002"}},
    {"at", {"frame:30.5", "frame:30.5"}},
    {"fps", {"23.976", "23.976"}},
    {"animation", {"Walk", "Walk"}},
    {"loop", {"on", "on"}},
    {"max-depth", {"0", "0"}},
    {"max-clear-depth", {"7", "7"}},
    {"filter", {"Box", "box"}},
    {"filter-radius", {"0.7px", "0.7"}},
    {"sampler", {"sobol", "sobol"}},
    {"light-choice", {"tree", "tree"}},
    {"targets", {"off", "off"}},
    {"clamp", {"1e3", "1000"}},
    {"traversal", {"fast", "fast"}},
    {"env", {"studio", "studio"}},
    {"env-rotate", {"-30°", "-30"}},
    {"env-strength", {"0.1", "0.1"}},
    {"background", {"0,0.3,1e-7", "0,0.3,1e-07"}},
    {"transparent", {"on", "on"}},
    {"spectral", {"rgb", "rgb"}},
    {"bins", {"380nm:730:10", "380:730:10"}},
    {"illuminant", {"a", "a"}},
    {"response", {"x.csv", "x.csv"}},
    {"white-balance", {"illuminant", "illuminant"}},
    {"camera", {"left", "left"}},
    {"look-at", {"0,1m,30cm,0,0,-1", "0,1,0.3,0,0,-1"}},
    {"pose", {"0,1,0,1e-1,-1,0,0,1,0,0,1,3", "0,1,0,0.1,-1,0,0,1,0,0,1,3"}},
    {"orbit", {"90deg", "90"}},
    {"orbit-about", {"1,2,3", "1,2,3"}},
    {"fov", {"40.1", "40.1"}},
    {"sensor", {"36mmx2.4cm", "36x24"}},
    {"focus", {"inf", "infinity"}},
    {"fstop", {"f/1.4", "1.4"}},
    {"lens-radius", {"1cm", "0.01"}},
    {"focal-length", {"5cm", "50"}},
    {"film-distance", {"51mm", "51"}},
    {"lens", {"Thin", "thin"}},
    {"glasses", {"my.agf", "my.agf"}},
    {"focus-by", {"traced", "traced"}},
    {"fit", {"fov", "fov"}},
    {"aperture", {"star:5", "star:5"}},
    {"aperture-scale", {"inscribed", "inscribed"}},
    {"iris-sampling", {"alias", "alias"}},
    {"dispersion", {"hero", "hero"}},
    {"coating", {"mgf2", "mgf2"}},
    {"ghosts", {"only", "only"}},
    {"diffraction", {"auto", "auto"}},
    {"lens-precision", {"double", "double"}},
    {"exposure-mode", {"photographic", "photographic"}},
    {"natural-vignetting", {"off", "off"}},
    {"iso", {"3200", "3200"}},
    {"shutter", {"1/125s", "0.008"}},
    {"shutter-curve", {"trapezoid", "trapezoid"}},
    {"output", {"a.exr", "a.exr"}},
    {"exposure", {"AUTO", "auto"}},
    {"view", {"raw", "raw"}},
    {"ocio", {"c.ocio", "c.ocio"}},
    {"aov", {"Depth", "depth"}},
    {"stats", {"s.json", "s.json"}},
    {"progress", {"json", "json"}},
    {"quiet", {"on", "on"}},
    {"frames", {"1:9:4", "1:9:4"}},
    {"turntable", {"12", "12"}},
    {"sweep", {"fstop=2,4", "fstop=2;4"}},
    {"sheet", {"s.png", "s.png"}},
    {"checkpoint", {"10m", "600"}},
    {"preview", {"p.jpg", "p.jpg"}},
    {"log", {"l.txt", "l.txt"}},
    {"skip-existing", {"on", "on"}}};

TEST(Fields, AnOrderWithoutWishesHasNone) {
    EXPECT_TRUE(fields_of(RenderOrder()).empty());
}

TEST(Fields, EachIsReadAndWrittenAgain) {
    std::set<std::string> names;
    for (const RequestField& field : request_fields()) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name << " is there twice";
        const auto known = kTexts.find(field.name);
        ASSERT_NE(known, kTexts.end()) << field.name << " needs a text";
        RenderOrder order;
        field.set(order, known->second.first);
        const std::vector<FieldTexts> written = fields_of(order);
        ASSERT_EQ(written.size(), 1u) << field.name << " changes that field alone";
        EXPECT_EQ(written[0].name, field.name);
        EXPECT_EQ(written[0].texts, std::vector<std::string>{known->second.second}) << field.name;
        const std::vector<FieldTexts> again = fields_of(order_of(written));
        ASSERT_EQ(again.size(), 1u) << field.name;
        EXPECT_EQ(again[0].texts, written[0].texts) << field.name;
    }
    EXPECT_EQ(names.size(), kTexts.size());
}

// Texts that an order holds are exact: floats have their shortest digits.
TEST(Fields, NumbersAreWrittenToTheBit) {
    RenderOrder order;
    const float odd = 0.1f + 0x1p-26f;
    order.render.scene.camera.fstop = odd;
    order.render.scene.camera.look_at = {V3f(odd, 1 / 3.f, -1e-7f), V3f(1e6f, 0, 0)};
    order.render.tolerance = 1. / 3;
    order.render.moment.shutter = ShutterTime{double(1 / 3.f), false};
    order.render.scene.picture_memory_bytes = 123'456'789;
    const RenderOrder again = order_of(fields_of(order));
    EXPECT_EQ(again.render.scene.camera.fstop, odd);
    EXPECT_EQ(again.render.scene.camera.look_at, order.render.scene.camera.look_at);
    EXPECT_EQ(again.render.tolerance, 1. / 3);
    EXPECT_EQ(again.render.moment.shutter->value, double(1 / 3.f));
    EXPECT_EQ(again.render.scene.picture_memory_bytes, 123'456'789u);
}

TEST(Fields, WhatHelpCallsTheDefaultIsIt) {
    const RenderOrder nothing;
    for (const RequestField& field : request_fields()) {
        const std::vector<std::string> texts = field.texts(nothing);
        if (texts.empty() || field.name == "env-rotate" || field.name == "env-strength" ||
            field.name == "threads" || field.name == "seed" || field.name == "tolerance")
            continue;  // that nothing is changed goes without saying
        EXPECT_NE(field.help.find("default"), std::string::npos) << field.name;
        EXPECT_NE(field.help.find(texts[0]), std::string::npos) << field.name << ": " << texts[0];
    }
}

TEST(Fields, AJobFollowsFromTheSamplesThatAreAskedFor) {
    RenderRequest request;
    EXPECT_EQ(job_of(request).end_sample, kUsualSamples);
    EXPECT_EQ(job_of(request).replicates, 1u);
    request.samples.time_limit_s = 1;
    EXPECT_EQ(job_of(request).end_sample, kMostSamples);
    request.samples.range = SampleRange{3, 9};
    EXPECT_EQ(job_of(request).first_sample, 3u);
    EXPECT_EQ(job_of(request).end_sample, 9u);
    request.samples.filter = FilterKind::Box;
    EXPECT_EQ(job_of(request).filter.radius_px(), 0.5f);
    request.scene.spectral.bins = Bins{400, 100, 3};
    EXPECT_EQ(job_of(request).replicates, kReplicates);
}

TEST(Fields, OneThatIsUnknownIsRefused) {
    EXPECT_THROW((void)order_of({{"fstp", {"2"}}}), ValueError);
    EXPECT_THROW((void)order_of({{"fstop", {"two"}}}), ValueError);
    EXPECT_THROW((void)order_of({{"quiet", {"off"}}}), ValueError);
}

TEST(Fields, PicturesOfASequenceHaveTheirOwn) {
    RenderOrder all;
    all.run.outputs = {"a_##.exr"};
    all.sequence.sweep = Sweep{"fstop", {"2", "f/4"}};
    const std::vector<SequenceItem> items = items_of(all.sequence);
    ASSERT_EQ(items.size(), 2u);
    const RenderOrder second = order_of(items[1], all, true);
    EXPECT_EQ(second.render.scene.camera.fstop, 4);
    EXPECT_EQ(second.run.outputs[0], "a_02.exr");
    EXPECT_FALSE(second.sequence.several());
    all.run.outputs = {"a.exr"};
    EXPECT_THROW((void)order_of(items[1], all, true), ValueError);
    all.sequence.sweep->field = "output";
    EXPECT_THROW((void)items_of(all.sequence), ValueError);
}

}  // namespace
}  // namespace petzval::apps
