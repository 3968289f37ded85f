# Included where tests are enabled.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME data.scenes COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/data/make_scenes.py --check)
set_tests_properties(data.scenes PROPERTIES LABELS "data" TIMEOUT 300 ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
