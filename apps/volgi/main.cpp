// volgi: the command line. Thin: options in, library calls, one line for an error, the documented exit code out.
#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

#include "apps/volgi/commands.h"
#include "apps/volgi/failure.h"
#include "apps/volgi/program_help.h"
#include "apps/volgi/program_ranks.h"
#include "core/error.h"
#include "volgi_version.h"

namespace {

using namespace volgi;

int run(int argc, char** argv, const app::ProgramRanks& ranks) {
  int exit_code = int(ExitCode::done);
  CLI::App app{"volgi: volume-based global illumination, and how wrong it is", "volgi"};
  app.set_version_flag("--version", VOLGI_VERSION);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  app.footer(
      "Exit codes: 0 done; 1 a comparison exceeded its limit; 2 wrong usage; 3 bad input file; 4 no usable GPU or "
      "context, or an OpenGL error;\n"
      "            5 out of memory or over a limit; 6 could not write the output.\nEach command: volgi COMMAND --help");
#ifdef VOLGI_HAS_GL
  app::add_render_command(app, exit_code);
#endif
  app::add_reference_command(app, exit_code);
  app::add_compare_command(app, exit_code);
  app::add_export_command(app, exit_code);
  app::add_merge_command(app, exit_code);
  app::add_inspect_command(app, exit_code);
#ifdef VOLGI_HAS_GL
  app::add_crosscheck_command(app, exit_code);
  app::add_bench_command(app, exit_code);
  app::add_report_command(app, exit_code);
  app::add_calibrate_command(app, exit_code);
#endif
  try {
    if (app::wrote_program_help(app, VOLGI_VERSION, argc, argv)) return exit_code;
    const std::string command = argc > 1 ? argv[1] : "";
    if (!command.starts_with("-") && command != "export" && command != "render" && command != "bench")
      app::refuse_several_ranks(command.c_str());
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForAllHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForVersion& e) {
    return app.exit(e);
  } catch (const CLI::RequiredError& e) {
    const bool unknown = argc > 1 && app.get_subcommands().empty();
    if (app::is_first_rank())
      std::cerr << "volgi: " << (unknown ? "no command '" + std::string(argv[1]) + "'" : e.what())
                << " (see volgi --help)\n";
    return ranks.end_all_alike(int(ExitCode::usage));
  } catch (const CLI::ParseError& e) {
    if (app::is_first_rank()) std::cerr << "volgi: " << e.what() << " (see volgi --help)\n";
    return ranks.end_all_alike(int(ExitCode::usage));
  } catch (...) {
    const int code = ranks.say_failure();
    ranks.end_all(code);
    return code;
  }
  return app::with_output_written(exit_code);
}

}  // namespace

int main(int argc, char** argv) {
  app::end_well_without_memory();
  try {
    const app::ProgramRanks ranks(argc, argv);
    return run(argc, argv, ranks);
  } catch (...) {
    return app::say_failure();
  }
}
