#!/bin/sh
# docs/settings.md on standard output. usage: settings_page.sh NEPHROID
cat <<'TEXT'
# Settings

Made by `./dev docs` from the program's own table (`nephroid settings`); do not edit.

A setting is given as `--set name=value` on the command line, as a line `name = value` of a file
for `--settings`, or as a parameter of `Integrator "photonmap"` in a scene. The names under *also*
mean the same everywhere; capitals do not matter in them.

TEXT
exec "$1" settings --markdown
