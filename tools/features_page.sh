#!/bin/sh
# docs/features.md on standard output. usage: features_page.sh NEPHROID
cat <<'TEXT'
# What of pbrt-v4 and glTF is rendered

Made by `nephroid features` from the tables that read scenes; do not edit. What is refused, and
every parameter that is not listed, is an error at its place in the file. A test exercises
every parameter: those of the fourth column change the image or a setting, those of the fifth
leave every bit as it is.

TEXT
exec "$1" features
