# cmake -DGLSLANG=glslangValidator -DDIR=expanded -P validate_shaders.cmake: fails at the first file that does not
# compile.
file(GLOB_RECURSE files ${DIR}/*.glsl)
foreach(file IN LISTS files)
  string(REGEX REPLACE ".*\\.([a-z]+)\\.glsl$" "\\1" stage ${file})
  execute_process(COMMAND ${GLSLANG} -S ${stage} ${file} RESULT_VARIABLE failed OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(failed)
    file(READ ${file} text)
    string(REGEX MATCHALL "//file [^\n]*" legend "${text}")
    message(FATAL_ERROR "${log}${legend}")
  endif()
endforeach()
file(TOUCH ${DIR}/stamp)
