#!/usr/bin/env bash
# ffmpeg decodes all pictures that node-ar-drone reads, without a word of complaint.
# usage: decode_video.sh FOLDER, with read_video.js and node-ar-drone in it
set -euo pipefail
film=$1/film.h264
read=$(node "$1/read_video.js" "$film")
said=$(ffmpeg -v error -xerror -i "$film" -f null - 2>&1 || echo "ffmpeg failed")
[ -z "$said" ] || { echo "$said"; exit 1; }
fields=codec_name,profile,width,height,has_b_frames,nb_read_frames
found=$(ffprobe -v error -count_frames -show_entries stream="$fields" -of csv=print_section=0 "$film")
pictures=$(sed -n 's/.*"pictures":\([0-9]*\).*/\1/p' <<<"$read")
[ "$found" = "h264,Constrained Baseline,640,360,0,$pictures" ] || { echo "$read, but ffprobe: $found"; exit 1; }
echo "has decoded $found"
