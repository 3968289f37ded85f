#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/gl/context.h"

namespace volgi::test {

/// Tests that need OpenGL: one context for the whole program, a visible skip where there is none, and a failure when
/// the driver reported an error during the test.
class GlTest : public ::testing::Test {
 protected:
  static gl::Context& context() { return *shared().context; }

  void SetUp() override {
    if (!shared().context) {
      if (std::getenv("VOLGI_REQUIRE_GL") != nullptr) FAIL() << "no OpenGL: " << shared().reason;
      GTEST_SKIP() << "no OpenGL: " << shared().reason;
    }
    errors_before_ = context().debug_errors();
  }

  void TearDown() override {
    if (shared().context) {
      EXPECT_EQ(context().debug_errors(), errors_before_) << "OpenGL errors, see stderr";
    }
  }

 private:
  struct Shared {
    std::unique_ptr<gl::Context> context;
    std::string reason;
  };
  static Shared& shared() {
    static Shared* const instance = [] {  // never destroyed: GL objects in static storage may outlive it
      auto* made = new Shared;
      try {
        made->context = std::make_unique<gl::Context>(gl::ContextOptions{.debug = true});
      } catch (const Error& error) {
        made->reason = error.what();
      }
      return made;
    }();
    return *instance;
  }
  int errors_before_ = 0;
};

}  // namespace volgi::test
