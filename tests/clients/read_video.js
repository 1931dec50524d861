// node-ar-drone, unmodified: its PaVEParser reads the video for some seconds and writes what is in it to a file.
const fs = require('fs');
const arDrone = require('ar-drone');
const PaVEParser = require('ar-drone/lib/video/PaVEParser');

const file = fs.openSync(process.argv[2], 'w');
const seconds = 5;
const seen = { pictures: 0, keys: 0, missing: 0, errors: 0 };
let last = null;
const wrong = (error) => { seen.errors += 1; console.error(error.message); };
const parser = new PaVEParser();
parser.on('error', wrong);
parser.on('data', (picture) => {
  seen.pictures += 1;
  seen.keys += picture.frame_type === 1 ? 1 : 0;
  seen.missing += last !== null && picture.frame_number !== last + 1 ? 1 : 0;
  last = picture.frame_number;
  fs.writeSync(file, picture.payload);
});
const client = arDrone.createClient({ ip: '127.0.0.1' });
const stream = client.getVideoStream();
stream.on('error', wrong);
stream.on('data', (bytes) => parser.write(bytes));
setTimeout(() => {
  fs.closeSync(file);
  console.log('has read', JSON.stringify(seen));
  const whole = seen.pictures > 20 * seconds && seen.keys > seconds && seen.missing + seen.errors === 0;
  process.exit(whole ? 0 : 1);
}, 1000 * (seconds + 1));
