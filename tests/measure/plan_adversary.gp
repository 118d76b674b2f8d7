# SPDX-License-Identifier: Apache-2.0
# Predicted against true errors of models, from the file that plan_adversary --csv writes:
#
#   gnuplot -e "csv='rows.csv'; svg='plan_adversary.svg'" tests/measure/plan_adversary.gp
#
# A mark for each model whose error was predicted, its bounds of 95 % as a bar; larger where the
# plan chose that model. Above the line the truth is worse than the promise. Errors below `least`
# are drawn there.
if (!exists("csv")) csv = 'plan_adversary.csv'
if (!exists("svg")) svg = 'plan_adversary.svg'
least = 0.02   # %
most = 200

set datafile separator comma
set encoding utf8
set terminal svg size 960,600 noenhanced font 'sans,14' background rgb 'white'
set output svg
set title 'Errors of simpler models: what plans promise, and what is true'
set xlabel 'predicted, at most (%)'
set ylabel 'true (%), with bounds of 95 %'
set logscale xy
set xrange [least:most]
set yrange [least:most]
set grid
set key outside right top

shown(share) = 100 * share < least ? least : 100 * share
kinds = 'prism lamps barcode glints caustic texture spectra rim'
is(kind) = strcol(2) eq kind && strcol(4) ne 'refused' && (column(5) > 0 || column(6) > 0)
size(chosen) = chosen > 0 ? 1.4 : 0.7
plot x with lines linewidth 2 linecolor 'gray40' title 'as promised', \
     2 * x with lines linewidth 2 dashtype 2 linecolor 'gray40' title 'twice the promise', \
     for [i = 1:words(kinds)] csv every ::1 \
         using (is(word(kinds, i)) ? shown(column(5)) : NaN):(shown(column(6))):(shown(column(7))):(shown(column(8))) \
         with yerrorbars linewidth 1 linecolor i pointtype 0 notitle, \
     for [i = 1:words(kinds)] csv every ::1 \
         using (is(word(kinds, i)) ? shown(column(5)) : NaN):(shown(column(6))):(size(column(9))) \
         with points linewidth 2 linecolor i pointtype 7 pointsize variable title word(kinds, i)
