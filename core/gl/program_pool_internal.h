#pragma once
#include <epoxy/gl.h>

#include <map>
#include <string>
#include <vector>

namespace volgi::gl {

/// Programs of a context that nobody uses at the moment, by what they were made from: a frame that is made anew with
/// other options, or for another picture size, compiles nothing twice. A program is lent to one owner at a time, since
/// it carries its uniforms. Programs end with their context; the pool frees none before.
class ProgramPool {
 public:
  /// With its uniforms as a new program has them. 0: there is none.
  GLuint take(const std::string& key);
  void give_back(const std::string& key, GLuint program);

 private:
  std::map<std::string, std::vector<GLuint>> free_;
};

/// Of the current context; null where there is none.
ProgramPool* program_pool();

}  // namespace volgi::gl
