# SPDX-License-Identifier: MIT
# Tables of docs/quality.md from results.csv; see the script `report`.
#   awk -v part=best     for each scene its file name, its name, the best other method at 1 sample
#   awk -v part=headline, losses, noise, scenes   the sections

BEGIN {
  FS = ","
  ours = "freqsynth"
  yardstick = "jittered-box"
  # Another, of which the summary tells alone. A fixed pattern is the stronger one of the two.
  fixed = "rotated-grid"
  # Columns of the measures, and their names.
  metrics = split("8 10 11 12 13", column, " ")
  split("RMSE|PSNR|relative MSE|SSIM|worst block", name, "|")
}

NR == 1 { next }

{
  if (!($1 in scene_seen)) { scene_seen[$1] = 1; scene[++scenes] = $1 }
  if (!($2 in method_seen)) { method_seen[$2] = 1; method[++methods] = $2 }
  if (!($3 in rate_seen)) { rate_seen[$3] = 1; rate[++rates] = $3 + 0 }
  for (i = 1; i <= NF; ++i) value[$1, $2, $3 + 0, i] = $i
}

function known(s, m, r) { return (s, m, r, 8) in value }

# The value of column c as an error, of which less is better: PSNR and SSIM are turned round.
function error(s, m, r, c,    v) {
  v = value[s, m, r, c]
  if (c == 10) return v == "inf" ? 0 : exp(-v * log(10) / 10)
  if (c == 12) return 1 - v
  return v + 0
}

# The method other than this library's with the least error in column c; "" when there is none.
function best_other(s, r, c,    i, m, best) {
  best = ""
  for (i = 1; i <= methods; ++i) {
    m = method[i]
    if (m == ours || index(m, ours "-") == 1 || !known(s, m, r)) continue
    if (best == "" || error(s, m, r, c) < error(s, best, r, c)) best = m
  }
  return best
}

function sort_rates(    i, j, r) {
  for (i = 2; i <= rates; ++i) {
    r = rate[i]
    for (j = i - 1; j >= 1 && rate[j] > r; --j) rate[j + 1] = rate[j]
    rate[j + 1] = r
  }
}

# Samples per pixel at which method m first has an error of e or less, by interpolation of the
# logarithms. Sets bound to "<" or ">" when its curve does not reach there.
function needed(s, m, e,    i, r, v, before, before_v) {
  bound = ""
  before = 0
  for (i = 1; i <= rates; ++i) {
    r = rate[i]
    if (!known(s, m, r)) continue
    v = error(s, m, r, 8)
    if (v <= e) {
      if (!before) { bound = "<"; return r }
      if (v == e || v <= 0) return r
      return exp(log(before) + (log(r) - log(before)) * log(before_v / e) / log(before_v / v))
    }
    before = r
    before_v = v
  }
  bound = ">"
  return before
}

function rate_text(r) {
  if (r < 1 && 1 / r == int(1 / r)) return "1/" 1 / r
  return r ""
}

function rate_name(r) { return rate_text(r) (r > 1 ? " samples" : " sample") " per pixel" }

function figure(x) { return sprintf("%.3g", x) }

# Of list[1 .. n], which is sorted.
function median(list, n,    i, j, x) {
  for (i = 2; i <= n; ++i) {
    x = list[i]
    for (j = i - 1; j >= 1 && list[j] > x; --j) list[j + 1] = list[j]
    list[j + 1] = x
  }
  return n % 2 ? list[(n + 1) / 2] : (list[n / 2] + list[n / 2 + 1]) / 2
}

function file_name(s) {
  gsub(/[^A-Za-z0-9.-]/, "_", s)
  return s
}

function headline(    i, k, s, r, v, n, count, won, m, ratio, logs, compared, doubt, need,
                  fixed_count) {
  print "| scene | samples | RMSE | jittered box needs | times as many | best other | ratio |"
  print "|---|---|---|---|---|---|---|"
  for (k = 1; k <= 3; ++k) count[k] = fixed_count[k] = won[k] = logs[k] = compared[k] = 0
  for (i = 1; i <= scenes; ++i) {
    s = scene[i]
    for (k = 1; k <= 3; ++k) {
      r = wanted[k]
      if (!known(s, ours, r)) continue
      v = error(s, ours, r, 8)
      if (known(s, fixed, r)) fixed_factor[k, ++fixed_count[k]] = needed(s, fixed, v) / r
      n = needed(s, yardstick, v)
      need = known(s, yardstick, r) ? bound figure(n) : "-"
      m = best_other(s, r, 8)
      doubt = v < 3 * value[s, ours, r, 18] ? " (*)" : ""
      if (doubt != "") doubts = 1
      if (known(s, yardstick, r)) factor[k, ++count[k]] = n / r
      if (m != "" && error(s, m, r, 8) > 0 && v > 0) {
        ratio = v / error(s, m, r, 8)
        ++compared[k]
        logs[k] += log(ratio)
        if (ratio < 1) ++won[k]
      }
      printf "| %s | %s | %s%s | %s | %s | %s | %s |\n", s, rate_text(r), figure(v), doubt, need,
        known(s, yardstick, r) ? bound figure(n / r) : "-", m == "" ? "-" : m,
        m == "" ? "-" : sprintf("%.2f", ratio)
    }
  }
  if (doubts) {
    print "\n(*) The reference itself is off by more than a third of this error."
  }
  print ""
  for (k = 1; k <= 3; ++k) {
    if (compared[k] == 0 || count[k] == 0) continue
    for (i = 1; i <= count[k]; ++i) list[i] = factor[k, i]
    printf "* At %s: the least RMSE of all systems in %d of %d scenes;\n",
      rate_name(wanted[k]), won[k], compared[k]
    printf "  %.2f times that of the best other system (geometric mean over the scenes);\n",
      exp(logs[k] / compared[k])
    printf "  the jittered box needs %.3g times as many samples (median; bounds count as they are)",
      median(list, count[k])
    if (fixed_count[k] == 0) {
      print "."
      continue
    }
    for (i = 1; i <= fixed_count[k]; ++i) list[i] = fixed_factor[k, i]
    printf ";\n  the rotated grid, the same in each pixel, needs %.3g times as many.\n",
      median(list, fixed_count[k])
  }
  # The greatest error relative to the yardstick's, from 1/4 sample per pixel on.
  worst = 0
  for (i = 1; i <= scenes; ++i) {
    for (j = 1; j <= rates; ++j) {
      if (rate[j] < 0.25 || !known(scene[i], ours, rate[j]) || \
          !known(scene[i], yardstick, rate[j])) continue
      ratio = error(scene[i], ours, rate[j], 8) / error(scene[i], yardstick, rate[j], 8)
      if (ratio > worst) { worst = ratio; worst_scene = scene[i]; worst_rate = rate[j] }
    }
  }
  if (worst > 0) {
    printf "* With the same number of samples, from 1/4 sample per pixel on, the RMSE is at most %.2f\n", worst
    printf "  times that of the jittered box (%s at %s).\n", worst_scene, rate_name(worst_rate)
  }
}

# How many times as great as the best other error ours is. Mean squares give the root of it, so
# that all measures compare.
function excess(s, r, k,    m, ratio) {
  if (!known(s, ours, r)) return 0
  m = best_other(s, r, column[k])
  if (m == "" || error(s, ours, r, column[k]) == 0) return 0
  if (error(s, m, r, column[k]) <= 0) return 1e9
  ratio = error(s, ours, r, column[k]) / error(s, m, r, column[k])
  return column[k] == 10 || column[k] == 11 ? sqrt(ratio) : ratio
}

function losses(    i, j, k, n, s, r, m, ratio, cells, names, lost, shown) {
  n = split(".0625 .25 1 4", shown, " ")
  lost = 0
  for (i = 1; i <= scenes; ++i) {
    s = scene[i]
    for (k = 1; k <= metrics; ++k) {
      cells = names = ""
      for (j = 1; j <= n; ++j) {
        r = shown[j] + 0
        ratio = excess(s, r, k)
        if (ratio <= 1.01) {
          cells = cells " |"
          continue
        }
        m = best_other(s, r, column[k])
        cells = cells " " (ratio >= 1000 ? ">1000" : ratio < 10 ? sprintf("%.2f", ratio) : \
          sprintf("%.0f", ratio)) " |"
        if (index(", " names ",", ", " m ",") == 0) names = names (names == "" ? "" : ", ") m
      }
      if (names == "") continue
      if (!lost++) {
        print "| scene | measure | 1/16 | 1/4 | 1 | 4 | better |"
        print "|---|---|---|---|---|---|---|"
      }
      printf "| %s | %s |%s %s |\n", s, name[k], cells, names
    }
  }
  if (!lost) print "Nowhere in these measurements."
  print ""
  lost = 0
  for (i = 1; i <= scenes; ++i) {
    for (j = 1; j <= rates; ++j) {
      if (!known(scene[i], ours, rate[j]) || value[scene[i], ours, rate[j], 14] == 0) continue
      if (!lost++) print "Blocks that freqsynth missed, of a picture:\n"
      printf "* %s at %s: %.3g\n", scene[i], rate_name(rate[j]), value[scene[i], ours, rate[j], 14]
    }
  }
  if (!lost) print "freqsynth missed no block."
}

function scene_tables(    i, j, s, m, r) {
  r = 1
  for (i = 1; i <= scenes; ++i) {
    s = scene[i]
    printf "%s### %s\n\n", i == 1 ? "" : "\n", s
    if ((s) in sheet) {
      printf "![%s](quality/%s)\n\n", s, sheet[s]
      printf "*From the left: freqsynth, jittered-box, %s, reference.*\n\n", best_other(s, 1, 8)
    }
    if (!known(s, ours, r)) continue
    print "| method | RMSE | +- | PSNR | rel. MSE | SSIM | worst | missed | seam | us |"
    print "|---|---|---|---|---|---|---|---|---|---|"
    for (j = 1; j <= methods; ++j) {
      m = method[j]
      if (!known(s, m, r)) continue
      printf "| %s | %s | %.1g | %.4g | %s | %.4f | %s | %.3g | %.3g | %.2f |\n", m,
        figure(value[s, m, r, 8]), value[s, m, r, 9], value[s, m, r, 10],
        figure(value[s, m, r, 11]), value[s, m, r, 12], figure(value[s, m, r, 13]),
        value[s, m, r, 14], value[s, m, r, 15], 1e6 * value[s, m, r, 23] / value[s, m, r, 7]
    }
    printf "\nThe reference is off by %s; a call of the scene takes %.2f us.\n",
      figure(value[s, ours, r, 18]), 1e6 * value[s, ours, r, 24] / value[s, ours, r, 7]
  }
}

# Scenes with a method that is made for noise, at the rates that denoisers are compared by. What the
# reference is off by is taken out of the RMSE.
function noise(    i, j, k, s, m, r, n, names, square, shown) {
  n = split(ours " " ours "-plain sobol-box nlm nfor", names, " ")
  split("1 4 16", shown, " ")
  print "| scene | samples | method | RMSE | relMSE | SSIM | mean | border | negative |"
  print "|---|---|---|---|---|---|---|---|---|"
  for (i = 1; i <= scenes; ++i) {
    s = scene[i]
    for (j = 1; j <= 3; ++j) {
      r = shown[j] + 0
      if (!known(s, "nlm", r)) continue
      for (k = 1; k <= n; ++k) {
        m = names[k]
        if (!known(s, m, r)) continue
        square = value[s, m, r, 8] ^ 2 - value[s, m, r, 18] ^ 2
        printf "| %s | %s | %s | %s | %s | %.4f | %.3f | %.2f | %.2g |\n", s, rate_text(r), m,
          figure(square > 0 ? sqrt(square) : 0), figure(value[s, m, r, 19]), value[s, m, r, 12],
          value[s, m, r, 20], value[s, m, r, 21], value[s, m, r, 22]
      }
    }
  }
}

END {
  sort_rates()
  split(".25 1 4", wanted, " ")
  for (i = 1; i <= 3; ++i) wanted[i] += 0
  while (sheets != "" && (getline line <sheets) > 0) {
    split(line, field, "\t")
    sheet[field[1]] = field[2]
  }
  if (part == "headline") headline()
  if (part == "losses") losses()
  if (part == "noise") noise()
  if (part == "scenes") scene_tables()
  if (part == "best") {
    for (i = 1; i <= scenes; ++i) {
      print file_name(scene[i]) "\t" scene[i] "\t" best_other(scene[i], 1, 8)
    }
  }
}
