// ardrone-autonomy, unmodified: what its example hover.js does, above a roundel at the start, whose sight corrects its
// estimate.
const autonomy = require('ardrone-autonomy');
const constants = require('ar-drone/lib/constants');

const mission = autonomy.createMission({ ip: '127.0.0.1' });
const option = (name) => 1 << constants.options[name];
const client = mission.client();
client.config('general:navdata_demo', true);
client.config('general:navdata_options',
  option('DEMO') | option('VISION_DETECT') | option('MAGNETO') | option('WIFI'));
client.config('video:video_channel', 1);
client.config('detect:detect_type', 12);
let last = null;
let seen = 0;
mission.control().on('controlData', (data) => { last = data.state; });
client.on('navdata', (data) => {
  if (data.visionDetect && data.visionDetect.nbDetected > 0) seen += 1;
});
const fail = setTimeout(() => { console.error('no end within 65 s', last); process.exit(1); }, 65000);
mission.takeoff().go({ x: 0, y: 0, z: 1.5 }).hover(30000).land();
mission.run((error) => {
  clearTimeout(fail);
  console.log('hover ended', error || 'well', `${seen} packets with a tag`, JSON.stringify(last));
  process.exit(!error && seen > 100 ? 0 : 1);
});
