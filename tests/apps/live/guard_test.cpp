// SPDX-License-Identifier: Apache-2.0
// Which requests a live server answers.
#include "apps/live/guard.h"

#include <gtest/gtest.h>

namespace petzval::apps {
namespace {

const ServerGate kLocal{{"127.0.0.1:8123", "localhost:8123"}, ""};

RequestHead head_of(const std::string& host) {
    RequestHead head;
    head.method = "GET";
    head.path = "/api/facts";
    head.host = host;
    return head;
}

TEST(LiveGuard, ItsOwnPageIsAnswered) {
    for (const char* host : {"127.0.0.1:8123", "localhost:8123"}) {
        RequestHead head = head_of(host);
        EXPECT_EQ(refusal_of(head, kLocal), "");
        head.origin = std::string("http://") + host;
        head.fetch_site = "same-origin";
        head.method = "POST";
        head.content_type = "application/json";
        EXPECT_EQ(refusal_of(head, kLocal), "");
    }
}

// DNS rebinding: a page of another site whose name leads to this machine.
TEST(LiveGuard, AnotherNameOfThisMachineIsRefused) {
    for (const char* host : {"", "example.com", "example.com:8123", "127.0.0.1", "127.0.0.1:80",
                             "127.0.0.1:8123.example.com", "[::1]:8123"})
        EXPECT_NE(refusal_of(head_of(host), kLocal), "") << host;
}

TEST(LiveGuard, RequestsOfOtherPagesAreRefused) {
    RequestHead head = head_of("127.0.0.1:8123");
    for (const char* origin : {"http://example.com", "https://127.0.0.1:8123", "null",
                               "http://127.0.0.1:8124", "http://localhost:8123"}) {
        head.origin = origin;
        EXPECT_NE(refusal_of(head, kLocal), "") << origin;
    }
    head.origin = "";
    for (const char* site : {"cross-site", "same-site"}) {
        head.fetch_site = site;
        EXPECT_NE(refusal_of(head, kLocal), "") << site;
    }
}

TEST(LiveGuard, ALinkOfAnotherPageMayLeadToThisOne) {
    RequestHead head = head_of("127.0.0.1:8123");
    head.path = "/";
    head.fetch_site = "cross-site";
    EXPECT_NE(refusal_of(head, kLocal), "");
    head.fetch_mode = "navigate";
    EXPECT_EQ(refusal_of(head, kLocal), "");
    head.path = "/api/events";
    EXPECT_NE(refusal_of(head, kLocal), "");
}

// Its length is what bounds it.
TEST(LiveGuard, ABodyIsSentAsItIs) {
    RequestHead head = head_of("127.0.0.1:8123");
    head.method = "POST";
    head.content_type = "application/json";
    head.encoded = true;
    EXPECT_NE(refusal_of(head, kLocal), "");
}

// What a form of another page can send is no JSON.
TEST(LiveGuard, WhatIsPostedIsJson) {
    RequestHead head = head_of("127.0.0.1:8123");
    head.method = "POST";
    for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded"}) {
        head.content_type = type;
        EXPECT_NE(refusal_of(head, kLocal), "") << type;
    }
}

TEST(LiveGuard, WithATokenTheAddressHasToHaveIt) {
    ServerGate gate{{"127.0.0.1:8123"}, random_token()};
    ASSERT_EQ(gate.token.size(), 32u);
    EXPECT_NE(gate.token, random_token());
    RequestHead head = head_of("192.168.1.7:8123");
    for (const std::string& path :
         {std::string("/"), std::string("/api/facts"), "/" + gate.token.substr(1) + "/",
          "/" + gate.token, "/x/" + gate.token + "/"}) {
        head.path = path;
        EXPECT_NE(refusal_of(head, gate), "") << path;
    }
    head.path = "/" + gate.token + "/api/facts";
    EXPECT_EQ(refusal_of(head, gate), "");
    EXPECT_EQ(path_behind_token(head.path, gate), "/api/facts");
    head.origin = "http://example.com";
    EXPECT_NE(refusal_of(head, gate), "");
}

}  // namespace
}  // namespace petzval::apps
