// volgi-demo: volume GI to hold and look into. Options in, a window or pictures out, one line for an error.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <new>

#include "apps/demo/default_scene.h"
#include "apps/demo/demo_options.h"
#include "apps/demo/lists.h"
#include "apps/demo/run_headless.h"
#include "apps/demo/run_volume.h"
#include "apps/demo/run_window.h"
#include "apps/volgi/program_help.h"
#include "core/error.h"
#include "volgi_version.h"

int main(int argc, char** argv) {
  using namespace volgi;
  CLI::App app{"volgi-demo: volume-based global illumination, live", "volgi-demo"};
  app.set_version_flag("--version", VOLGI_VERSION);
  app.failure_message(CLI::FailureMessage::simple);
  demo::DemoOptions options;
  options.add_to(app);
  try {
    if (app::wrote_program_help(app, VOLGI_VERSION, argc, argv)) return int(ExitCode::done);
    app.parse(argc, argv);
    if (!options.list.empty()) {
      std::cout << demo::list_of(options.list);
      return int(ExitCode::done);
    }
    if (options.scenes.empty()) options.scenes.push_back(demo::default_scene());
    options.frame.volume.limit_threads();
    if (demo::is_volume(options)) return demo::run_volume(options);
    return options.headless || !options.benchmark.empty() ? demo::run_headless(options) : demo::run_window(options);
  } catch (const CLI::CallForHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForVersion& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::cerr << "volgi-demo: " << e.what() << " (see volgi-demo --help)\n";
    return int(ExitCode::usage);
  } catch (const Error& e) {
    std::cerr << "volgi-demo: " << e.what() << '\n';
    return int(e.code());
  } catch (const std::bad_alloc&) {
    std::cerr << "volgi-demo: out of memory; try a smaller --grid or --size\n";
    return int(ExitCode::over_limit);
  } catch (const std::exception& e) {
    std::cerr << "volgi-demo: " << e.what() << '\n';
    return int(ExitCode::bad_input);
  }
}
