// node-ar-drone, unmodified, with the ffmpeg that it starts: pictures of the video as PNG.
const arDrone = require('ar-drone');

const least = 30;
let seen = 0;
const fail = setTimeout(() => { console.error('no end within 60 s', seen); process.exit(1); }, 60000);
const stream = arDrone.createClient({ ip: '127.0.0.1' }).getPngStream();
stream.on('error', (error) => { console.error(error.message); process.exit(1); });
stream.on('data', (picture) => {
  // Width and height, behind the signature and the first chunk's name.
  const size = [picture.readUInt32BE(16), picture.readUInt32BE(20)];
  if (size[0] !== 640 || size[1] !== 360) { console.error('a picture of', size); process.exit(1); }
  seen += 1;
  if (seen < least) return;
  clearTimeout(fail);
  console.log('has seen', seen, 'pictures of', size.join(' x '));
  process.exit(0);
});
